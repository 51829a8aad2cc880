function [good, errors] = bht_controls_check(filename, tmax, parameters, tol)
%BHT_CONTROLS_CHECK  Check the derivatives of a controls M-file.
%   good = BHT_CONTROLS_CHECK(filename, tmax, parameters, tol) compares dc and dttc of [c, dc, dttc] = f(t, parameters) with
%   central differences of theoretical accuracy tol (1e-8 unless given) at 400 times from 0 to tmax (10), and plots the angles.
%   good is false, and a line is printed, if a derivative is wrong. Rates that are not 0 at t = 0 are reported: the swimmer's
%   initial velocity then does not mean that all of it is at rest, and it may drift.
%
%   [good, errors] = ... the largest errors of dc and dttc of each control, relative to their size: controls x 2.

if nargin < 2
    tmax = 10;
end
if nargin < 3
    parameters = [];
end
if nargin < 4
    tol = 1e-8;
end
f = filename;
if ischar(f)
    f = str2func(regexprep(f, '\.m$', ''));
end
h = sqrt(tol);
times = linspace(0, tmax, 400);
[c, dc, ~] = f(0, parameters);
n = numel(c);
all_of = zeros(n, 3, numel(times));
wrong = zeros(n, 2, numel(times));
change = zeros(n, 2, numel(times));
for k = 1:numel(times)
    t = times(k);
    here = sample(f, t, parameters, n);
    near = (sample(f, t + h, parameters, n) - sample(f, t - h, parameters, n)) / (2 * h);
    far = (sample(f, t + 2 * h, parameters, n) - sample(f, t - 2 * h, parameters, n)) / (4 * h);
    all_of(:, :, k) = here;
    wrong(:, :, k) = abs(near(:, 1:2) - here(:, 2:3));
    change(:, :, k) = abs(far(:, 1:2) - near(:, 1:2));
end
scale = max(max(abs(all_of(:, 2:3, :)), [], 3), 1e-300);
errors = max(wrong, [], 3) ./ scale;
allowed = 10 * max(change, [], 3) ./ scale + 10 * tol * max(1, max(abs(all_of(:, 1:2, :)), [], 3) ./ scale);
good = true;
names = {'dc', 'dttc'};
for k = 1:n
    for der = 1:2
        if ~(errors(k, der) <= allowed(k, der))
            good = false;
            fprintf('control %d: %s is wrong by %.1e (allowed %.1e)\n', k, names{der}, errors(k, der), allowed(k, der));
        end
    end
end
if any(abs(dc(:)) > 1e-12)
    fprintf('dc at t = 0 is not 0: the body may drift\n');
end
plot(times, reshape(all_of(:, 1, :), n, []));
xlabel('t');
ylabel('controls');
end

function x = sample(f, t, parameters, n)
[c, dc, ddc] = f(t, parameters);
if numel(c) ~= n || numel(dc) ~= n || numel(ddc) ~= n
    error('nekton:bht:controls', 'the controls at t = %g have lengths %d, %d, %d instead of %d', t, numel(c), numel(dc), numel(ddc), n);
end
x = [c(:), dc(:), ddc(:)];
if ~all(isfinite(x(:)))
    error('nekton:bht:controls', 'a control at t = %g is not finite', t);
end
end
