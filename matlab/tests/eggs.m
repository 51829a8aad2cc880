function scene = eggs()
% Two free ellipses.
egg = @(a, b) struct('shape', struct('ellipse', [a b]), 'density', 1, 'nodes', 96);
one = struct('position', [0 0], 'angle', pi / 3, 'velocity', [0.5 0], 'angular_velocity', -0.5, 'link', egg(2, 1));
two = struct('position', [3 3], 'angle', pi / 4, 'velocity', [-0.6 0.5], 'angular_velocity', 0, 'link', egg(1.5, 0.8));
scene = struct('body', [one, two]);
end
