function [good, errors] = bht_boundary_check(filename, settings, tol)
%BHT_BOUNDARY_CHECK  Check and draw a boundary M-file.
%   good = BHT_BOUNDARY_CHECK(filename, settings, tol) draws the boundary with tangents (red), normals (blue) and centroid,
%   compares its first and second derivatives with central differences of theoretical accuracy tol (1e-8 unless given),
%   and plots both errors. good is false, and a line is printed, if a derivative is wrong or the curve is not closed.
%
%   [good, errors] = ... the largest errors of the first and second derivative, relative to their size.

if nargin < 3
    tol = 1e-8;
end
f = filename;
if ischar(f)
    f = str2func(regexprep(f, '\.m$', ''));
end
n = 400;
t = (0:n - 1) * 2 * pi / n;
h = sqrt(tol);
good = true;
errors = zeros(1, 2);
curves = zeros(2, n);
for der = 1:2
    exact = points(f, t, der, settings);
    near = (points(f, mod(t + h, 2 * pi), der - 1, settings) - points(f, mod(t - h, 2 * pi), der - 1, settings)) / (2 * h);
    far = (points(f, mod(t + 2 * h, 2 * pi), der - 1, settings) - points(f, mod(t - 2 * h, 2 * pi), der - 1, settings)) / (4 * h);
    size_of = max(max(abs(exact)));
    curves(der, :) = sqrt(sum((near - exact).^2, 1)) / size_of;
    errors(der) = max(curves(der, :));
    % The difference's own error is a third of what changes when its step is doubled.
    allowed = 10 * max(max(abs(far - near))) / size_of + 10 * tol;
    if ~(errors(der) <= allowed)
        good = false;
        fprintf('derivative %d is wrong by %.1e (allowed %.1e)\n', der, errors(der), allowed);
    end
end
y = points(f, t, 0, settings);
dy = points(f, t, 1, settings);
gap = max(abs(points(f, 2 * pi, 0, settings) - y(:, 1)));
if ~(gap <= 1e-6 * max(max(abs(y))) + 1e-12)
    good = false;
    fprintf('the curve is not closed: it misses its start by %.1e\n', gap);
end
[area, centroid] = bht_area(y, dy);
if area < 0
    fprintf('the boundary runs clockwise\n');
end

subplot(1, 2, 1);
plot([y(1, :) y(1, 1)], [y(2, :) y(2, 1)], 'k', centroid(1), centroid(2), 'k+');
hold('on');
k = 1:20:n;
length_of = 0.1 * max(max(y, [], 2) - min(y, [], 2));
tau = dy(:, k) ./ repmat(sqrt(sum(dy(:, k).^2, 1)), 2, 1) * length_of;
plot([y(1, k); y(1, k) + tau(1, :)], [y(2, k); y(2, k) + tau(2, :)], 'r');
plot([y(1, k); y(1, k) + tau(2, :)], [y(2, k); y(2, k) - tau(1, :)], 'b');
hold('off');
axis('equal');
title('boundary');
subplot(1, 2, 2);
semilogy(t, max(curves(1, :), 1e-17), t, max(curves(2, :), 1e-17));
legend('first', 'second derivative');
xlabel('t');
title('relative error');
end

function y = points(f, t, der, settings)
y = f(t, der, settings);
if ~isequal(size(y), [2, numel(t)])
    error('nekton:bht:boundary', 'the boundary function gave an array of %d x %d instead of 2 x %d', size(y, 1), size(y, 2), numel(t));
end
if ~all(isfinite(y(:)))
    error('nekton:bht:boundary', 'the boundary function gave a number that is not finite');
end
end
