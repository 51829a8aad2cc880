function scene = swimmer(motion)
% Two ellipses and a hinge; motion as nekton_scene takes it.
head = struct('name', 'head', 'shape', struct('ellipse', [1 0.35]), 'density', 1, 'nodes', 48);
tail = struct('name', 'tail', 'shape', struct('ellipse', [0.8 0.2]), 'density', 1, 'nodes', 48, 'parent', 'head', ...
    'hinge', struct('parent', [-1.1 0], 'self', [0.9 0]));
if nargin > 0
    tail.motion = motion;
end
scene = struct('body', struct('name', 'fish', 'link', {{head, tail}}));
end
