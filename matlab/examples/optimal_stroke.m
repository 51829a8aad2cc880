function [best, history] = optimal_stroke(varargin)
%OPTIMAL_STROKE  The cheapest stroke of a three-link swimmer for a given displacement.
%   optimal_stroke          searches, shows the progress and plots the stroke before and after
%   optimal_stroke(file)    writes the plot into a PNG file;  optimal_stroke(file, n) tries about n strokes instead of 60
%   [best, history] = ...   parameters of the stroke found, and the cost after each iteration
%
%   Minimized is the integral of |nu|^2 over one period, where nu are the torques in the two joints ((7.5) in Munnier and
%   Pincon). The swimmer starts from rest and its joint angles are
%       c1 = w a1 sin(k t), c2 = w a2 sin(k t + phase), k = 1
%   with a window w that rises smoothly over the first quarter and falls over the last. The search is over (a1, a2, phase),
%   by fminsearch. That the displacement is as asked for is kept exactly: for every trial both amplitudes are scaled until it is, so no
%   penalty is needed.

asked = 0.25;
start = [0.5, 0.5, -2.3];
fprintf('displacement asked for: %.3f\n', asked);
history = [];
first = scaled(start, asked);
tries = 60;
if nargin > 1
    tries = varargin{2};
end
options = optimset('MaxFunEvals', tries, 'TolX', 1e-3, 'TolFun', 1e-4, 'Display', 'off');
ratio = fminsearch(@cost, [start(2) / start(1), start(3)], options);
best = scaled([1, ratio], asked);
if best.cost > first.cost
    best = first;
end
fprintf('cost %.5f before, %.5f after (%.1f %% less); displacement %.6f and %.6f\n', first.cost, best.cost, ...
    100 * (1 - best.cost / first.cost), first.moved, best.moved);

visible = 'on';
if nargin > 0
    visible = 'off';
end
fig = figure('visible', visible);
names = {'before', 'after'};
both = {first, best};
for k = 1:2
    r = both{k};
    subplot(2, 2, k);
    plot(r.t, r.c);
    title(sprintf('%s: cost %.4f', names{k}, r.cost));
    ylabel('joint angles');
    subplot(2, 2, 2 + k);
    plot(r.t, r.torques);
    ylabel('torques');
    xlabel('t');
end
if nargin > 0
    nekton_print(fig, varargin{1});
    close(fig);
end

    function j = cost(p)
        r = scaled([1, p], asked);
        j = r.cost;
        if isempty(history) || j < min(history)
            fprintf('%3d  cost %.5f  amplitudes %.3f %.3f  phase %.3f\n', numel(history) + 1, j, r.p);
        end
        history(end + 1) = j;
    end
end

function r = scaled(p, asked)
% The stroke with these proportions whose displacement is as asked for (cost Inf: it would need angles beyond 1.2 rad).
p(1:2) = p(1:2) / max(abs(p(1:2)));
% A secant search for the square z of the amplitude, of which the displacement is almost a linear function.
z = [0, 0.5];
wrong = -asked;
for k = 1:12
    r = swim([sqrt(z(2)) * p(1:2), p(3)]);
    error_now = r.moved - asked;
    if abs(error_now) < 1e-6
        return
    end
    next = z(2) - error_now * (z(2) - z(1)) / (error_now - wrong);
    z = [z(2), min(max(next, 0.01), 1.44)];
    wrong = error_now;
    if z(1) == z(2)
        break
    end
end
r.cost = Inf;
end

function r = swim(p)
% Displacement of the centre of mass over one stroke, and the integral of the squared torques.
period = 4 * pi;
link = @(name) struct('name', name, 'shape', struct('ellipse', [1 0.3]), 'density', 1, 'nodes', 32);
links = {link('first'), link('middle'), link('last')};
links{2}.parent = 'first';
links{3}.parent = 'middle';
joint = struct('parent', [-1.3 0], 'self', [1.3 0]);
window = [0, period, period / 4];
links{2}.hinge = joint;
links{3}.hinge = joint;
links{2}.motion = struct('harmonic', [p(1), 1, 0, 0], 'window', window);
links{3}.motion = struct('harmonic', [p(2), 1, p(3), 0], 'window', window);
sim = Nekton(struct('body', struct('link', {links})), 'tolerance', 1e-6);
n = 81;
r.p = p;
r.t = linspace(0, period, n)';
r.c = zeros(n, 2);
r.torques = zeros(n, 2);
before = sim.positions();
for k = 1:n
    sim.show(r.t(k), period);
    r.c(k, :) = sim.joints()';
    r.torques(k, :) = sim.torques()';
end
after = sim.positions();
r.moved = norm(mean(after(1:2, :), 2) - mean(before(1:2, :), 2));
% The torques and all their derivatives vanish at both ends, so this rule is of any order.
r.cost = sum(sum(r.torques.^2)) * (r.t(2) - r.t(1));
delete(sim);
end
