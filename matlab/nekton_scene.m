function [scene, names, run] = nekton_scene(given, controlled)
%NEKTON_SCENE  Check a scene and bring it into the form that nekton_mex takes.
%   [scene, names, run] = NEKTON_SCENE(given) takes a struct with the keys of docs/scene-file.md as fields:
%
%     fluid         struct: density (1), gravity (0)
%     repulsion     struct: alpha (4), epsilon (0.01)
%     circulation   struct: model ('full' or 'paper')
%     tank          struct: shape, position, angle, nodes
%     obstacle      struct array or cell: the same and circulation
%     body          struct array or cell: name, position, angle, velocity, angular_velocity, root, link
%     run           struct: duration, output_interval, integrator, force, quadrature, tolerance, allow_unresolved, shortcuts
%
%   A body's link (struct array or cell) has name, shape, nodes, circulation, density (or mass, inertia, centre_of_mass),
%   parent, hinge (or slider) and motion. A shape is a struct with one of the fields ellipse = [a b],
%   star = [radius amplitude lobes], rectangle = [width height], polygon = n x 2, curve = n x 2, and perhaps radius (of the
%   corners) or corners (of a curve: 'auto', 'none' or numbers of points). A motion is a struct with harmonic (and window) or table = n x 4 with rows (t, u, du, ddu), or locked, or torque
%   (and stiffness, damping, rest, start); the text 'control' stands for what the simulation's function of controls gives,
%   as a motion and as a torque.
%
%   nodes = 'auto' takes as many as run.tolerance (the relative error in space, 1e-6) needs; so does a boundary without `nodes`.
%
%   names has the fields body, link (both by link) and joint: texts. run is the struct of the same name.
%
%   [...] = NEKTON_SCENE(given, true): a joint without motion is driven by the controls.
%
%   Errors: nekton:scene:... names the place and what is wrong there.

if nargin < 2
    controlled = false;
end
known(given, {'fluid', 'repulsion', 'circulation', 'tank', 'obstacle', 'body', 'run'}, 'the scene');
fluid = get(given, 'fluid', struct());
known(fluid, {'density', 'gravity'}, 'fluid');
scene = struct('fluid_density', get(fluid, 'density', 1), 'gravity', get(fluid, 'gravity', 0));
repulsion = get(given, 'repulsion', []);
if ~isempty(repulsion)
    known(repulsion, {'alpha', 'epsilon'}, 'repulsion');
    scene.repulsion_alpha = get(repulsion, 'alpha', 4);
    scene.repulsion_epsilon = get(repulsion, 'epsilon', 0.01);
end
circulation = get(given, 'circulation', struct());
known(circulation, {'model'}, 'circulation');
scene.circulation = get(circulation, 'model', 'full');
run = get(given, 'run', struct());
known(run, {'duration', 'output_interval', 'integrator', 'force', 'quadrature', 'tolerance', 'allow_unresolved', 'shortcuts'}, 'run');
scene.force = get(run, 'force', 'exact');
scene.quadrature = get(run, 'quadrature', 'graded');
scene.tolerance = get(run, 'tolerance', []);
scene.shortcuts = double(get(run, 'shortcuts', true));
scene.allow_unresolved = double(get(run, 'allow_unresolved', false));

tank = get(given, 'tank', []);
if ~isempty(tank)
    scene.tank = wall(tank, 'the tank');
end
obstacles = items(get(given, 'obstacle', []));
for k = 1:numel(obstacles)
    scene.obstacles(k) = wall(obstacles{k}, sprintf('obstacle %d', k));
end

names = struct('body', {{}}, 'link', {{}}, 'joint', {{}});
bodies = items(get(given, 'body', []));
for k = 1:numel(bodies)
    [scene.bodies(k), own] = body(bodies{k}, k, controlled);
    names.body = [names.body, own.body];
    names.link = [names.link, own.link];
    names.joint = [names.joint, own.joint];
end
end

function w = wall(given, where)
known(given, {'shape', 'position', 'angle', 'nodes', 'circulation'}, where);
w = struct('shape', shape(given, where), 'position', get(given, 'position', [0 0]), 'angle', get(given, 'angle', 0), ...
    'nodes', get(given, 'nodes', []), 'circulation', get(given, 'circulation', 0));
end

function s = shape(given, where)
s = get(given, 'shape', []);
known(s, {'ellipse', 'star', 'rectangle', 'polygon', 'curve', 'radius', 'corners'}, ['the shape of ' where]);
if isfield(s, 'star') && isstruct(s.star)
    s.star = [s.star.radius, s.star.amplitude, s.star.lobes];
end
for key = {'polygon', 'curve'}
    if isfield(s, key{1}) && ischar(s.(key{1}))
        error('nekton:scene:shape', '%s: names of files are not supported here; give the points', where);
    end
end
end

function [b, names] = body(given, index, controlled)
where = sprintf('body %d', index);
known(given, {'name', 'position', 'angle', 'velocity', 'angular_velocity', 'root', 'link'}, where);
where = get(given, 'name', sprintf('body%d', index));
position = get(given, 'position', [0 0]);
velocity = get(given, 'velocity', [0 0]);
b.pose = [position(:); get(given, 'angle', 0)];
b.velocity = [velocity(:); get(given, 'angular_velocity', 0)];
b.root = {};
root = get(given, 'root', []);
if ~isempty(root)
    known(root, {'x', 'y', 'theta'}, [where '.root']);
    b.root = {signal(get(root, 'x', 0), where), signal(get(root, 'y', 0), where), signal(get(root, 'theta', 0), where)};
end

links = items(get(given, 'link', []));
n = numel(links);
if n == 0
    error('nekton:scene:links', '%s has no link', where);
end
own = cell(1, n);
parents = cell(1, n);
for k = 1:n
    known(links{k}, {'name', 'shape', 'nodes', 'circulation', 'density', 'mass', 'inertia', 'centre_of_mass', 'parent', ...
        'hinge', 'slider', 'motion'}, sprintf('link %d of %s', k, where));
    own{k} = get(links{k}, 'name', sprintf('link%d', k));
    parents{k} = get(links{k}, 'parent', '');
end
if numel(unique(own)) < n
    error('nekton:scene:name', '%s: two links have the same name', where);
end

% Parents come before their children; else in the order given.
order = [];
while numel(order) < n
    before = numel(order);
    for k = 1:n
        if ~any(order == k)
            parent = find(strcmp(own, parents{k}));
            if isempty(parents{k}) && numel(order) == 0 || ~isempty(parent) && any(order == parent)
                order(end + 1) = k; %#ok<AGROW>
            end
        end
    end
    if numel(order) == before
        error('nekton:scene:parent', '%s: every link but one, the root, must have a parent in the same body', where);
    end
end

names = struct('body', {repmat({where}, 1, n)}, 'link', {own(order)}, 'joint', {{}});
for k = 1:n
    given = links{order(k)};
    place = [where '.' own{order(k)}];
    parent = find(strcmp(own(order), parents{order(k)}));
    one = struct('shape', shape(given, place), 'nodes', get(given, 'nodes', []), 'circulation', get(given, 'circulation', 0), ...
        'density', get(given, 'density', []), 'mass', get(given, 'mass', []), 'inertia', get(given, 'inertia', []), ...
        'centre_of_mass', get(given, 'centre_of_mass', []), 'parent', 0, 'joint', 'hinge', 'drive', 'locked', 'axis', [], ...
        'locked_value', 0, 'angle', 0, 'parent_anchor', [], 'self_anchor', [], 'signal', [], 'stiffness', 0, 'damping', 0, ...
        'rest', 0, 'start', [0 0]);
    if isempty(one.mass) == isempty(one.density)
        error('nekton:scene:mass', '%s: give either density or mass', place);
    end
    if ~isempty(parent)
        one.parent = parent;
        one = joint(one, given, place, controlled);
        names.joint{end + 1} = place;
    end
    b.links(k) = one;
end
end

function one = joint(one, given, place, controlled)
kind = intersect({'hinge', 'slider'}, fieldnames(given));
kind = kind(cellfun(@(f) ~isempty(given.(f)), kind));
if numel(kind) ~= 1
    error('nekton:scene:joint', '%s has a parent, so it needs a hinge or a slider', place);
end
one.joint = kind{1};
j = given.(kind{1});
known(j, {'parent', 'self', 'axis', 'angle'}, [place '.' kind{1}]);
one.parent_anchor = get(j, 'parent', [0 0]);
one.self_anchor = get(j, 'self', [0 0]);
one.axis = get(j, 'axis', []);
one.angle = get(j, 'angle', 0);
motion = get(given, 'motion', []);
if isempty(motion) && controlled
    motion = 'control';
end
if isempty(motion)
    error('nekton:scene:motion', '%s: how does the joint move? Give motion, or controls to the simulation', place);
elseif ischar(motion) || isnumeric(motion)
    one.drive = 'motion';
    one.signal = signal(motion, place);
elseif ~isempty(get(motion, 'locked', []))
    known(motion, {'locked'}, [place '.motion']);
    one.locked_value = motion.locked;
elseif ~isempty(get(motion, 'torque', []))
    known(motion, {'torque', 'stiffness', 'damping', 'rest', 'start'}, [place '.motion']);
    one.drive = 'torque';
    one.signal = signal(motion.torque, place);
    for key = {'stiffness', 'damping', 'rest', 'start'}
        one.(key{1}) = get(motion, key{1}, one.(key{1}));
    end
else
    one.drive = 'motion';
    one.signal = signal(motion, place);
end
end

function s = signal(given, where)
if ischar(given)
    if ~strcmp(given, 'control')
        error('nekton:scene:signal', '%s: a signal is a number, a struct, or ''control''', where);
    end
    s = 'channel';
elseif isnumeric(given)
    s = given;
elseif ~isempty(get(given, 'table', []))
    known(given, {'table'}, where);
    s = given.table;
    if ischar(s)
        error('nekton:scene:signal', '%s: names of files are not supported here; give the rows (t, u, du, ddu)', where);
    end
else
    known(given, {'harmonic', 'window'}, [where '.motion']);
    terms = get(given, 'harmonic', []);
    if isnumeric(terms)
        s.harmonic = terms;
    else
        terms = items(terms);
        s.harmonic = zeros(numel(terms), 4);
        for k = 1:numel(terms)
            known(terms{k}, {'amplitude', 'frequency', 'phase', 'offset'}, [where '.motion.harmonic']);
            s.harmonic(k, :) = [get(terms{k}, 'amplitude', 0), get(terms{k}, 'frequency', 0), get(terms{k}, 'phase', 0), ...
                get(terms{k}, 'offset', 0)];
        end
    end
    window = get(given, 'window', []);
    if isstruct(window)
        known(window, {'from', 'to', 'ramp'}, [where '.motion.window']);
        window = [get(window, 'from', 0), get(window, 'to', 0), get(window, 'ramp', 0)];
    end
    s.window = window;
end
end

function known(s, names, where)
if ~isstruct(s) || numel(s) ~= 1
    error('nekton:scene:class', '%s must be given by one struct', where);
end
unknown = setdiff(fieldnames(s), names);
if ~isempty(unknown)
    error('nekton:scene:field', '%s has no field ''%s''; it has: %s', where, unknown{1}, strtrim(sprintf('%s ', names{:})));
end
end

function value = get(s, name, default)
if isfield(s, name) && ~isempty(s.(name))
    value = s.(name);
else
    value = default;
end
end

function list = items(given)
% Struct arrays and cells of structs alike.
if isempty(given)
    list = {};
elseif iscell(given)
    list = given(:)';
else
    list = num2cell(given(:)');
end
end
