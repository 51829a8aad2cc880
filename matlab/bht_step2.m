function [x, dx, ddx] = bht_step2(t, epsilon, a)
%BHT_STEP2  Infinitely smooth step up and down with two derivatives.
%   [x, dx, ddx] = BHT_STEP2(t, epsilon, a): 0 outside (0, a), 1 between epsilon and a - epsilon; 2 epsilon <= a.
%   (The meaning of the arguments in the old toolbox is not public; this is our choice.)

if 2 * epsilon > a
    error('nekton:bht:step', 'bht_step2: 2 epsilon must not exceed a');
end
[up, dup, ddup] = bht_step1(t, epsilon);
[down, ddown, dddown] = bht_step1(a - t, epsilon);
x = up .* down;
dx = dup .* down - up .* ddown;
ddx = ddup .* down - 2 * dup .* ddown + up .* dddown;
end
