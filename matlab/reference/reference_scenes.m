function [scene, y, t_end, own] = reference_scenes(name, n)
%REFERENCE_SCENES  'two_ellipses' (the paper's section 9.2) or 'fish' with n nodes per link: for reference_rhs, its initial
%   state and final time, and the same scene for Nekton.
none = @(t) deal(zeros(0, 1), zeros(0, 1), zeros(0, 1));
link = @(a, b, body, parent, father, self) struct('a', a, 'b', b, 'density', 1, 'body', body, 'parent', parent, ...
    'father_anchor', father, 'own_anchor', self);
shape = @(name, a, b) struct('name', name, 'shape', struct('ellipse', [a b]), 'density', 1, 'nodes', n);
switch name
    case 'two_ellipses'
        links = [link(2, 0.9, 1, 0, [], []), link(2, 0.9, 2, 0, [], [])];
        scene = struct('density', 1, 'n', n, 'links', links, 'controls', none);
        y = [2; -1.1; 0; -2; 1.1; 0; -0.5; 0; 0; 0.5; 0; 0];
        t_end = 16;
        own.body = {struct('position', [2 -1.1], 'velocity', [-0.5 0], 'link', shape('a', 2, 0.9)), ...
            struct('position', [-2 1.1], 'velocity', [0.5 0], 'link', shape('b', 2, 0.9))};
    case 'fish'
        a = [1, 0.9, 0.8, 0.8];
        b = [0.35, 0.32, 0.25, 0.14];
        father = [1.1, 1, 0.9];
        self = [1, 0.9, 0.9];
        amplitude = [0.4; 0.6; 0.8];
        phase = [0; -1.2; -2.4];
        names = {'head', 'front', 'rear', 'tail'};
        links = link(a(1), b(1), 1, 0, [], []);
        bodies = {shape(names{1}, a(1), b(1))};
        for k = 2:4
            links(k) = link(a(k), b(k), 1, k - 1, [-father(k - 1), 0], [self(k - 1), 0]);
            bodies{k} = shape(names{k}, a(k), b(k));
            bodies{k}.parent = names{k - 1};
            bodies{k}.hinge = struct('parent', [-father(k - 1), 0], 'self', [self(k - 1), 0]);
            bodies{k}.motion = struct('harmonic', [amplitude(k - 1), 1, phase(k - 1), 0], 'window', [0, 6 * pi, 2 * pi]);
        end
        scene = struct('density', 1, 'n', n, 'links', links, 'controls', @(t) stroke(t, amplitude, phase));
        y = zeros(6, 1);
        t_end = 20;
        own.body = struct('name', 'fish', 'link', {bodies});
    otherwise
        error('reference_scenes: two_ellipses or fish');
end
end

function [c, dc, ddc] = stroke(t, amplitude, phase)
[w, dw, ddw] = bht_step2(t, 2 * pi, 6 * pi);
s = amplitude .* sin(t + phase);
ds = amplitude .* cos(t + phase);
c = w * s;
dc = dw * s + w * ds;
ddc = ddw * s + 2 * dw * ds - w * s;
end
