function test_reference()
% The paper's algorithm, written independently in plain matrix code, gives the same accelerations.
here = fileparts(fileparts(mfilename('fullpath')));
addpath(fullfile(here, 'reference'));
[scene, ~, ~, own] = reference_scenes('two_ellipses', 96);
sim = Nekton(own, 'tolerance', 1e-8);
sim.advance(3);
dy = reference_rhs(sim.time(), sim.state(), scene);
near(dy(7:12), sim.accelerations(), 1e-9);

[scene, ~, ~, own] = reference_scenes('fish', 128);
sim = Nekton(own, 'tolerance', 1e-5);
sim.advance(4);
q = sim.positions();
v = sim.velocities();
a = sim.accelerations();
dy = reference_rhs(4, [q(:, 1); v(:, 1)], scene);
near(dy(4:6), a(:, 1), 1e-6);

% One solve to the end of a short run.
[scene, y, ~, own] = reference_scenes('two_ellipses', 64);
sim = Nekton(own, 'tolerance', 1e-8);
sim.advance(3);
for solver = {'adams', 'ode45'}
    end_state = reference_solve(scene, y, [0 3], 1e-8, solver{1});
    near(end_state, sim.state(), 1e-5);
end
end
