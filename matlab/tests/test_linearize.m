function test_linearize()
% Linearizations are the derivatives of the rates; names are counted from 1 and refused with a list of what there is.
beat = struct('harmonic', struct('amplitude', 0.4, 'frequency', 2, 'phase', 0.3));
agrees(Nekton(swimmer(beat)), {'fluid_density', 'link2.mass', 'joint1.position'});
sim = Nekton(eggs());
agrees(sim, {'gravity', 'link1.force_x', 'link2.force_y', 'link2.torque', 'link2.inertia', 'fluid_density'});

% An unloaded spring that is turned by an angle is a torque.
sim = Nekton(swimmer(struct('torque', 0.2, 'stiffness', 0.5, 'start', [0.3 -0.2])));
names = {'joint1.torque', 'joint1.stiffness', 'joint1.damping', 'joint1.rest'};
[A, B, bound] = sim.linearize(names);
agrees(sim, names);
assert(bound >= 0 && bound < 1);
near(B(:, 4), 0.5 * B(:, 1), 1e-12 * max(abs(B(:))));
only = sim.linearize();
near(only, A, 0);

% A force from outside accelerates as the mass matrix says.
sim = Nekton(eggs());
[A, B] = sim.linearize({'link2.force_y'});
wanted = sim.massMatrix() \ [0 0 0 0 1 0]';
near(B, [zeros(6, 1); wanted], 1e-9);

% Asking changes nothing.
[one, two] = deal(Nekton(eggs(), 'tolerance', 1e-7), Nekton(eggs(), 'tolerance', 1e-7));
for k = 1:3
    one.linearize({'gravity'});
    one.step();
    two.step();
    near(one.state(), two.state(), 0);
end

raises('nekton:arg:parameter', @() sim.linearize({'link3.mass'}));
raises('nekton:arg:parameter', @() sim.linearize({'joint1.torque'}));
raises('nekton:arg:parameter', @() sim.linearize({'link0.mass'}));
raises('nekton:arg:class', @() sim.linearize('gravity'));
raises('nekton:arg:class', @() sim.linearize({1}));
try
    sim.linearize({'weight'});
catch problem
    assert(~isempty(strfind(problem.message, 'weight')) && ~isempty(strfind(problem.message, 'link2.force_x')));
end
whirl = eggs();
whirl.body(1).link.circulation = 0.5;
agrees(Nekton(whirl), {});
end

function agrees(sim, names)
% A against differences of rhs; B has a column for each name.
[A, B] = sim.linearize(names);
[y, t] = sim.state();
assert(isequal(size(A), numel(y) * [1 1]) && isequal(size(B), [numel(y), numel(names)]));
assert(all(isfinite(B(:))));
weights = [4/5, -1/5, 4/105, -1/280];
h = 2e-3;
for k = 1:numel(y)
    column = zeros(numel(y), 1);
    for m = 1:4
        shift = zeros(numel(y), 1);
        shift(k) = m * h;
        column = column + weights(m) * (sim.rhs(t, y + shift) - sim.rhs(t, y - shift)) / h;
    end
    near(A(:, k), column, 1e-7 * max(1, max(abs(column))));
end
end
