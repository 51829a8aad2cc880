function test_corners()
% Corners of a curve through points: found, given by numbers from 1, left out, and wrong ones refused.
side = [-1 -0.5 0 0.5]';
one = ones(4, 1);
points = [side, -one; one, side; -side, one; -one, -side];
exact = 4.753758460905903;
near(mass(points, {}), exact * [1 1], 1e-5);
near(mass(points, {'corners', 'auto'}), exact * [1 1], 1e-5);
near(mass(points, {'corners', [13 1 5 9]}), exact * [1 1], 1e-5);
near(mass(points(1:2:end, :), {'corners', [1 3 5 7]}), exact * [1 1], 1e-5);
smooth = mass(points, {'corners', 'none'});
assert(all(smooth > exact + 1e-3), 'a smooth curve bulges round the corners');
raises('nekton:scene:OutOfRange', @() mass(points, {'corners', [1 17]}));
raises('nekton:arg:range', @() mass(points, {'corners', [0 5]}));
raises('nekton:arg:range', @() mass(points, {'corners', 1.5}));
raises('nekton:arg:word', @() mass(points, {'corners', 'some'}));
end

function m = mass(points, more)
shape = struct('curve', points, more{:});
sim = Nekton(struct('fluid', struct('density', 1), 'body', struct('link', struct('shape', shape, 'density', 1))));
m = diag(sim.addedMass())';
m = m(1:2);
end
