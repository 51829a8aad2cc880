function test_ode()
% Octave's and Matlab's own ode solvers, driving rhs, reach what advance reaches.
sim = Nekton(eggs(), 'tolerance', 1e-11);
y = sim.state();
[~, Y] = ode45(@(t, y) sim.rhs(t, y), [0 2], y, odeset('RelTol', 1e-9, 'AbsTol', 1e-9));
assert(sim.time() == 0);
sim.advance(2);
near(Y(end, :)', sim.state(), 1e-7);
if exist('lsode', 'builtin')
    lsode_options('relative tolerance', 1e-10);
    lsode_options('absolute tolerance', 1e-10);
    Y = lsode(@(y, t) sim.rhs(t, y), y, [0 2]);
    near(Y(end, :)', sim.state(), 1e-7);
    lsode(@(y, t) 0, 0, [0 1]); % lsode keeps its last function, and with it the simulation
end

controls = @(t) deal(0.5 * sin(t)^3, 1.5 * sin(t)^2 * cos(t), 3 * sin(t) * cos(t)^2 - 1.5 * sin(t)^3);
sim = Nekton(swimmer(), 'controls', controls, 'tolerance', 1e-11, 'control_step', 0.01);
[~, Y] = ode45(@(t, y) sim.rhs(t, y), [0 2], sim.state(), odeset('RelTol', 1e-9, 'AbsTol', 1e-9));
sim.advance(2);
near(Y(end, :)', sim.state(), 1e-7);
end
