function [x, dx, ddx] = bht_step1(t, epsilon)
%BHT_STEP1  Infinitely smooth step with two derivatives.
%   [x, dx, ddx] = BHT_STEP1(t, epsilon): 0 for t <= 0, 1 for t >= epsilon. epsilon is 1 unless given.
%   (The meaning of epsilon in the old toolbox is not public; this is our choice.)

if nargin < 2
    epsilon = 1;
end
s = t / epsilon;
x = double(s >= 1);
dx = zeros(size(t));
ddx = zeros(size(t));
% Closer to the ends the step is 0 or 1 to rounding.
inside = s > 1e-3 & s < 1 - 1e-3;
s = s(inside);
g = 1 ./ s - 1 ./ (1 - s);
dg = -1 ./ s.^2 - 1 ./ (1 - s).^2;
ddg = 2 ./ s.^3 - 2 ./ (1 - s).^3;
y = 1 ./ (1 + exp(g));
slope = y ./ (1 + exp(-g));
x(inside) = y;
dx(inside) = -dg .* slope / epsilon;
ddx(inside) = (dg.^2 .* (1 - 2 * y) - ddg) .* slope / epsilon^2;
end
