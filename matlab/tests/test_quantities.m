function test_quantities()
% Added mass of an ellipse has its closed form; mass matrix, energy, gap, outlines and rates agree with one another.
a = 2;
b = 1;
rho = 1.3;
one = struct('shape', struct('ellipse', [a b]), 'density', 0.7);
sim = Nekton(struct('fluid', struct('density', rho), 'body', struct('velocity', [1 2], 'angular_velocity', 0.5, 'link', one)));
near(sim.addedMass(), rho * pi * diag([b^2, a^2, (a^2 - b^2)^2 / 8]), 1e-12);
m = 0.7 * pi * a * b;
near(sim.massMatrix() - sim.addedMass(), diag([m, m, m * (a^2 + b^2) / 4]), 1e-12);
v = sim.velocities();
e = sim.energy();
near(e.total, 0.5 * v' * sim.massMatrix() * v, 1e-12);
assert(isinf(sim.gap()));

sim = Nekton(eggs());
e = sim.energy();
v = sim.velocities();
v = v(:);
near(e.total, 0.5 * v' * sim.massMatrix() * v, 1e-10);
[d, places] = sim.gap();
assert(d > 0.1 && d < 3);
near(places, [4 1 1; 4 2 1], 0);
near([sim.links.area], pi * [2, 1.2], 1e-10);
[outlines, walls] = sim.outlines(50);
assert(numel(outlines) == 2 && isempty(walls));
near(mean(outlines{2}(:, 1:49), 2), [3; 3], 1e-10);
dy = sim.rhs(0, sim.state());
near(dy(7:12), sim.accelerations(), 1e-12);
near(dy(1:6), v, 1e-15);
end
