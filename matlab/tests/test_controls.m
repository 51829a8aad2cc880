function test_controls()
% Controls from a function move the swimmer as the same motion built in does; each time is evaluated once; rhs agrees.
motion = struct('harmonic', [0.5 2 0.2 0.1]);
built_in = Nekton(swimmer(motion), 'tolerance', 1e-11);
global calls
calls = [];
sim = Nekton(swimmer(), 'tolerance', 1e-11, 'controls', @counted, 'parameters', [0.5 2 0.2 0.1]);
near(sim.positions(), built_in.positions(), 1e-14);
near(sim.velocities(), built_in.velocities(), 1e-12);
for t = [0.33, 1, 2]
    sim.advance(t);
    built_in.advance(t);
    near(sim.positions(), built_in.positions(), 2e-8);
    near(sim.velocities(), built_in.velocities(), 2e-7);
end
assert(numel(calls) <= 45 && numel(unique(round(calls * 1e6))) >= 41, 'called %d times', numel(calls));
[torque, power] = sim.torques();
[expected, work] = built_in.torques();
near([torque, power], [expected, work], 1e-5);
near(power, torque * 2 * 0.5 * cos(2 * 2 + 0.2), 1e-6);
assert(iscellstr(sim.jointNames) && strcmp(sim.jointNames{1}, 'fish.tail'));

% rhs by controls leaves the simulation's own controls alone.
[y, t] = sim.state();
torque = sim.torques();
dy = sim.rhs(t, y);
sim.rhs(7, y);
near(sim.torques(), torque, 1e-12);
v = sim.velocities();
near(dy(1:3), v(:, 1), 1e-12);

% A lone swimmer without controls: moved by a torque from a function.
spring = struct('torque', 'control', 'stiffness', 0.5, 'start', [0 0]);
driven = Nekton(swimmer(spring), 'controls', @(t) deal(0.1 * sin(t), 0.1 * cos(t), -0.1 * sin(t)));
built_in = Nekton(swimmer(struct('torque', struct('harmonic', [0.1 1 0 0]), 'stiffness', 0.5)));
driven.advance(3);
built_in.advance(3);
near(driven.positions(), built_in.positions(), 1e-7);
e = driven.energy();
near(e.total - e.work, 0, 1e-7);
end

function [c, dc, ddc] = counted(t, p)
global calls
calls(end + 1) = t;
c = p(1) * sin(p(2) * t + p(3)) + p(4);
dc = p(1) * p(2) * cos(p(2) * t + p(3));
ddc = -p(1) * p(2)^2 * sin(p(2) * t + p(3));
end
