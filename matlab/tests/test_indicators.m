function test_indicators()
% Error indicators bound the error, a missed tolerance is one warning, automatic nodes follow the tolerance.
disc = @(x, v, n) struct('position', [x 0], 'velocity', v, ...
    'link', struct('shape', struct('ellipse', [1 1]), 'density', 1, 'nodes', n));
scene = @(n, run) struct('body', [disc(-1.2, [0.1 0], n), disc(1.2, [-0.1 0.05], n)], 'run', run);
run = struct('quadrature', 'plain');

% The bound is no less than the error.
exact = Nekton(scene(192, run));
refused = Nekton(scene(16, run));
raises('nekton:sim:BoundExceeded', @() refused.addedMass());
delete(refused);
run.allow_unresolved = true;
coarse = Nekton(scene(16, run));
M = exact.addedMass();
e = max(max(abs(coarse.addedMass() - M))) / max(max(abs(M)));
r = coarse.resolution();
s = coarse.indicators();
assert(e > 1e-5 && r.bound >= e && s.bound >= e && r.bound == 100 * max([r.mass, r.force, r.quadrature]) && r.repulsion == 0);
delete(exact);
delete(coarse);

% One warning for one episode, without a tolerance above a thousandth, none when it is met.
for tolerance = {[], 1e3, 1e-10}
    run.tolerance = tolerance{1};
    sim = Nekton(scene(16, run));
    lastwarn('', '');
    evalc('sim.advance(0.1)'); % a warning that is off would leave no trace
    [~, id] = lastwarn();
    assert(strcmp(id, 'nekton:sim:Unresolved') == ~isequal(tolerance{1}, 1e3));
    lastwarn('', '');
    evalc('sim.advance(0.2); sim.step();');
    [~, id] = lastwarn();
    assert(isempty(id), 'a second warning for the same episode');
    r = sim.indicators();
    assert(r.bound > 1e-10);
    delete(sim);
end

% Automatic nodes.
run = struct('tolerance', 1e-4);
few = Nekton(scene('auto', run));
run.tolerance = 1e-10;
many = Nekton(scene('auto', run));
assert(few.plan.tolerance == 1e-4 && many.plan.tolerance == 1e-10);
assert(few.links(1).nodes < many.links(1).nodes && mod(few.links(1).nodes, 2) == 0);
delete(few);
delete(many);
raises('nekton:arg:word', @() Nekton(scene('many', run)));
for bad = [-1, 1e-17]
    run.tolerance = bad;
    raises('nekton:scene:BadTolerance', @() Nekton(scene('auto', run)));
end
run.tolerance = NaN;
raises('nekton:arg:finite', @() Nekton(scene('auto', run)));
end
