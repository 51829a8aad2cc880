function test_arguments()
% Wrong class, size and values of arguments are refused by name and change nothing.
mex = @nekton_mex;
method = {'adams', [0 1e-9 1e-9 0 0]};
good = nekton_scene(eggs());
raises('nekton:arg:count', mex);
raises('nekton:arg:text', mex, 3);
raises('nekton:arg:command', mex, 'fly');
raises('nekton:arg:count', mex, 'create', good);
raises('nekton:scene:class', mex, 'create', 5, method{:});
raises('nekton:arg:word', mex, 'create', good, 'euler', [0 1 1 0 0]);
raises('nekton:arg:size', mex, 'create', good, 'adams', 1);
raises('nekton:scene:BadTolerance', mex, 'create', good, 'adams', [0 0 0 0 0]);
raises('nekton:scene:BadStep', mex, 'create', good, 'rk4', [-1 0 0 0 0]);
raises('nekton:scene:EmptyScene', mex, 'create', struct('gravity', 1), method{:});
for field = {'fluid_density', 'gravity'}
    for bad = {single(1), 'x', {1}, 1i, sparse(1), int32(1), true}
        scene = good;
        scene.(field{1}) = bad{1};
        raises('nekton:arg:class', mex, 'create', scene, method{:});
    end
    scene = good;
    scene.(field{1}) = NaN;
    raises('nekton:arg:finite', mex, 'create', scene, method{:});
    scene.(field{1}) = [1 2];
    raises('nekton:arg:size', mex, 'create', scene, method{:});
end
scene = good;
scene.colour = 1;
raises('nekton:scene:field', mex, 'create', scene, method{:});
scene = good;
scene.fluid_density = -1;
raises('nekton:scene:OutOfRange', mex, 'create', scene, method{:});
scene = eggs();
scene.body(1).link.nodes = 7;
raises('nekton:scene:NodeCount', @() Nekton(scene));
scene.body(1).link.nodes = 8.5;
raises('nekton:arg:range', @() Nekton(scene));
scene = eggs();
scene.body(2).position = [1 0];
raises('nekton:scene:Overlap', @() Nekton(scene));
scene = eggs();
scene.run.quadrature = 'plain';
delete(Nekton(scene));
scene.run.quadrature = 'gauss';
raises('nekton:arg:word', @() Nekton(scene));
scene = eggs();
scene.body(1).colour = 1;
raises('nekton:scene:field', @() Nekton(scene));
scene = eggs();
scene.body(1).link.shape = struct('curve', [1 2 3]);
raises('nekton:arg:size', @() Nekton(scene));
raises('nekton:scene:shape', @() Nekton(struct('body', struct('link', struct('shape', struct('radius', 1), 'density', 1)))));
raises('nekton:scene:motion', @() Nekton(swimmer()));
raises('nekton:arg:controls', @() Nekton(swimmer('control')));
raises('nekton:arg:option', @() Nekton(eggs(), 'speed', 1));
raises('nekton:scene:file', @() Nekton('no_such_file.json'));

sim = Nekton(eggs());
sim.advance(0.5);
[y, t] = sim.state();
raises('nekton:arg:class', @() sim.advance('x'));
raises('nekton:arg:size', @() sim.advance([1 2]));
raises('nekton:arg:finite', @() sim.advance(NaN));
raises('nekton:arg:finite', @() sim.advance(Inf));
raises('nekton:sim:PastTime', @() sim.advance(0.4));
raises('nekton:arg:size', @() sim.rhs(0, [1 2 3]));
raises('nekton:arg:class', @() sim.rhs(0, single(y)));
raises('nekton:arg:finite', @() sim.rhs(0, y * NaN));
raises('nekton:arg:finite', @() sim.setState(0, y * NaN));
raises('nekton:arg:size', @() sim.setState(0, y(1:3)));
raises('nekton:arg:word', @() sim.outline('fin', 1, 1, 0));
raises('nekton:model:OutOfRange', @() sim.outline('link', 3, 1, 0));
[y1, t1] = sim.state();
assert(isequal(y, y1) && t == t1);
sim.advance(1);
end
