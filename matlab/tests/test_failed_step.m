function test_failed_step()
% An advance that fails keeps the steps that it made, on course; a call without a step leaves the simulation to the bit.
disc = @(x, v) struct('position', [x 0], 'velocity', [v 0], 'link', struct('shape', struct('ellipse', [0.5 0.5]), 'density', 1));
scene = struct('fluid', struct('density', 0), 'body', [disc(-1, 1), disc(1, -1)]);
sim = Nekton(scene);
sim.advance(0.3);
[y, t] = sim.state();
raises('nekton:sim:PastTime', @() sim.advance(0.2));
[y1, t1] = sim.state();
assert(isequal(y, y1) && t == t1);
sim = Nekton(scene, 'method', 'rk4', 'step', 0.01);
raises('nekton:sim:Contact', @() sim.advance(2));
t = sim.time();
assert(t > 0.48 && t < 0.5);
near(sim.positions(), [t - 1, 0, 0, 1 - t, 0, 0], 1e-12);
sim.advance(0.495);
near(sim.positions(), [-0.505 0 0 0.505 0 0], 1e-12);

% With controls: a function that fails, or gives nonsense, on its way.
sim = Nekton(swimmer(), 'controls', @broken);
raises('test:broken', @() sim.advance(2));
assert(sim.time() <= 1 && sim.time() > 0.8);
sim.advance(sim.time());
near(sim.joints(), 0.1 * sin(sim.time())^3, 1e-10);
sim = Nekton(swimmer(), 'controls', @nonsense);
raises('nekton:arg:finite', @() sim.advance(2));
sim.energy();
end

function [c, dc, ddc] = broken(t)
if t > 1.01
    error('test:broken', 'as planned');
end
c = 0.1 * sin(t)^3;
dc = 0.3 * sin(t)^2 * cos(t);
ddc = 0.6 * sin(t) * cos(t)^2 - 0.3 * sin(t)^3;
end

function [c, dc, ddc] = nonsense(t)
c = 0 * t;
dc = 0;
ddc = 0;
if t > 1
    dc = NaN;
end
end
