function [gene_data, scene] = bht_data_compile(varargin)
%BHT_DATA_COMPILE  Read a DAT-file of the old toolbox.
%   gene_data = BHT_DATA_COMPILE('DataFilename', name) or BHT_DATA_COMPILE(name) reads name or name.dat into a struct with the
%   fields fluid_density, gravity, max_time, time_step, collisions, alpha, epsilon, problem_type, fish, obstacle, tank.
%   [gene_data, scene] = ... also gives the scene for Nekton (and nekton_scene).
%
%   Options
%     'ControlsFilename', f    also writes the template f.m of the controls, unless there is such a file
%     'HingeFrames', 'centroid' (default) or 'drawing'
%
%   The file is read as one long text. What is no key word followed by = is a comment, and so is what follows a % on a line. Values
%   are Matlab expressions and end with the line (outside of brackets), with ; or with the next key word. Every field is
%   optional: a missing one gets the default given here in brackets, with a warning. Whatever else looks like "word =" is
%   reported by a warning.
%
%     fluid density [1]   max time [10]   time step [0.1]   collisions yes/no [no]   alpha, epsilon [4, 0.01; if collisions = yes]
%     problem type [unbounded; read but not used: a tank makes the problem bounded]
%     fish = { initial position [0;0;0]   initial velocity [0;0;0]   link = { ... } ... }       (any number)
%     link = { label [link1, ...]   mfilename [bht_ellipse]   settings [0 0 1 0.5 1]
%              father   hinge coord [0 0]   hinge local coord [0 0] }                           (any number, the father first)
%
%   Our choice, as the old key words are not public: gravity [0], along -y; number of points [64; 128 for
%   bht_round_rectangle], of the whole scene or of one link or wall; density [1] of a link (also: solid density);
%   obstacle = { mfilename settings number of points } and tank = { ... }, in the main frame.
%
%   initial position: centre of gravity and angle of the head, the link without father. Hinge coordinates: in the frame of the
%   father and of the link itself. 'centroid': the frames are those that the old toolbox's compiler makes, with the
%   centroid of the outline as origin. 'drawing': the frames in which the boundary M-files draw.
%
%   Boundaries bht_ellipse and bht_round_rectangle are taken as the exact shapes; any other M-file [y, ...] = f(t, der, settings) as the
%   smooth closed curve through number-of-points of its points. Orientation does not matter.
%
%   Identifiers of the warnings: nekton:bht:missing, nekton:bht:unknown, nekton:bht:ignored.

options = bht_options(struct('DataFilename', '', 'ControlsFilename', '', 'HingeFrames', 'centroid'), varargin{:});
if ~any(strcmp(options.HingeFrames, {'centroid', 'drawing'}))
    error('nekton:bht:option', 'HingeFrames is centroid or drawing');
end
name = options.DataFilename;
if exist(name, 'file') ~= 2 && exist([name '.dat'], 'file') == 2
    name = [name '.dat'];
end
if isempty(name) || exist(name, 'file') ~= 2
    error('nekton:bht:file', 'there is no file %s', name);
end
text = regexprep(fileread(name), '%[^\n]*', '');

gene_data = defaults(block(text, 'top', 'the file'), {'fluid_density', 1; 'problem_type', 'unbounded'; 'max_time', 10; ...
    'time_step', 0.1; 'collisions', 'no'}, 'the file');
gene_data = quiet(gene_data, {'gravity', 0; 'alpha', []; 'epsilon', []; 'number_of_points', []});
if strcmp(gene_data.collisions, 'yes')
    for key = {'alpha', 4; 'epsilon', 0.01}'
        if isempty(gene_data.(key{1}))
            gene_data = rmfield(gene_data, key{1});
            gene_data = defaults(gene_data, key', 'the file');
        end
    end
elseif ~strcmp(gene_data.collisions, 'no')
    error('nekton:bht:value', 'collisions is yes or no, not %s', gene_data.collisions);
end
scene.fluid = struct('density', gene_data.fluid_density, 'gravity', gene_data.gravity);
if strcmp(gene_data.collisions, 'yes')
    scene.repulsion = struct('alpha', gene_data.alpha, 'epsilon', gene_data.epsilon);
end

walls = {'obstacle', 'tank'};
for w = 1:2
    kind = walls{w};
    list = items(gene_data, kind);
    gene_data.(kind) = {};
    for k = 1:numel(list)
        where = sprintf('%s %d', kind, k);
        one = defaults(list{k}, {'mfilename', 'bht_ellipse'; 'settings', [0 0 1 0.5 1]}, where);
        one = quiet(one, {'number_of_points', gene_data.number_of_points});
        gene_data.(kind){k} = one;
        [shape, at] = boundary(one, where);
        wall = struct('shape', shape, 'position', at, 'nodes', nodes(one));
        if w == 1
            scene.obstacle{k} = wall;
        elseif k == 1
            scene.tank = wall;
        else
            error('nekton:bht:value', 'there can be one tank only');
        end
    end
end

fish = items(gene_data, 'fish');
gene_data.fish = {};
scene.body = {};
joints = {};
for k = 1:numel(fish)
    where = sprintf('fish %d', k);
    one = defaults(fish{k}, {'initial_position', [0; 0; 0]; 'initial_velocity', [0; 0; 0]}, where);
    links = items(one, 'link');
    if isempty(links)
        error('nekton:bht:value', '%s has no link', where);
    end
    one.link = {};
    body = struct('name', sprintf('fish%d', k), 'position', one.initial_position(1:2)', 'angle', one.initial_position(3), ...
        'velocity', one.initial_velocity(1:2)', 'angular_velocity', one.initial_velocity(3), 'link', {{}});
    centroids = struct();
    labels = {};
    for j = 1:numel(links)
        place = sprintf('link %d of %s', j, where);
        link = defaults(links{j}, {'label', sprintf('link%d', j); 'mfilename', 'bht_ellipse'; 'settings', [0 0 1 0.5 1]}, place);
        link = quiet(link, {'density', 1; 'father', ''; 'number_of_points', gene_data.number_of_points});
        [shape, at, centroid] = boundary(link, place);
        def = struct('name', link.label, 'shape', shape, 'density', link.density, 'nodes', nodes(link));
        labels{end + 1} = link.label; %#ok<AGROW>
        centroids.(sprintf('c%d', j)) = centroid;
        if ~isempty(link.father)
            link = defaults(link, {'hinge_coord', [0 0]; 'hinge_local_coord', [0 0]}, place);
            father = find(strcmp(labels(1:j - 1), link.father));
            if numel(father) ~= 1
                error('nekton:bht:father', '%s: there is no earlier link with the label %s', place, link.father);
            end
            def.parent = link.father;
            hinge = {link.hinge_coord(:)', link.hinge_local_coord(:)'};
            if strcmp(options.HingeFrames, 'drawing')
                hinge{1} = hinge{1} - centroids.(sprintf('c%d', father))(:)';
                hinge{2} = hinge{2} - centroid(:)';
            end
            def.hinge = struct('parent', hinge{1}, 'self', hinge{2});
            joints{end + 1} = sprintf('fish %d, %s on %s', k, link.label, link.father); %#ok<AGROW>
        end
        one.link{j} = link;
        body.link{j} = def;
    end
    gene_data.fish{k} = one;
    scene.body{k} = body;
end
gene_data.joints = joints;

if ~isempty(options.ControlsFilename)
    template(options.ControlsFilename, joints);
end
end

function found = block(text, level, where)
% Fields of a block: a struct by key; blocks as cells of structs.
keys = struct();
keys.top = {'fluid density', 'problem type', 'max time', 'time step', 'collisions', 'alpha', 'epsilon', 'gravity', ...
    'number of points', 'fish', 'obstacle', 'tank'};
keys.fish = {'initial position', 'initial velocity', 'link'};
keys.link = {'label', 'mfilename', 'settings', 'father', 'hinge local coord', 'hinge coord', 'solid density', 'density', ...
    'number of points'};
keys.obstacle = {'mfilename', 'settings', 'number of points'};
keys.tank = keys.obstacle;
texts = {'problem type', 'collisions', 'label', 'mfilename', 'father'};
blocks = {'fish', 'link', 'obstacle', 'tank'};
pattern = ['(?<!\w)(' strrep(strjoin(keys.(level), '|'), ' ', '\s+') ')\s*$'];

found = struct();
from = 1;
while true
    equals = find(text(from:end) == '=', 1) + from - 1;
    if isempty(equals)
        break
    end
    before = text(from:equals - 1);
    key = regexpi(before, pattern, 'tokens', 'once');
    start = equals + 1;
    while start <= numel(text) && isspace(text(start))
        start = start + 1;
    end
    opens = start <= numel(text) && text(start) == '{';
    if isempty(key)
        word = regexp(before, '([A-Za-z_]\w*(\([^()]*\))?)\s*$', 'tokens', 'once');
        if ~isempty(word)
            warning('nekton:bht:unknown', '%s: ''%s ='' is not a key word here; it is ignored', where, word{1});
        end
        from = equals + 1;
        if opens
            from = closing(text, start, where) + 1;
        end
        continue
    end
    key = lower(regexprep(key{1}, '\s+', ' '));
    field = strrep(strrep(key, 'solid density', 'density'), ' ', '_');
    if any(strcmp(key, blocks))
        if ~opens
            error('nekton:bht:syntax', '%s: %s = must be followed by {', where, key);
        end
        last = closing(text, start, where);
        inner = block(text(start + 1:last - 1), key, [where ', ' key]);
        if ~isfield(found, field)
            found.(field) = {};
        end
        found.(field){end + 1} = inner;
        from = last + 1;
        continue
    end
    last = value_end(text, start);
    raw = text(start:last);
    % The value also ends where the next key word begins.
    next = regexpi(raw, ['(?<!\w)(' strrep(strjoin(keys.(level), '|'), ' ', '\s+') '|[A-Za-z_]\w*)\s*='], 'start', 'once');
    if ~isempty(next)
        raw = raw(1:next - 1);
        last = start + next - 2;
    end
    raw = strtrim(raw);
    if any(strcmp(key, texts))
        value = regexprep(raw, '^[''"](.*)[''"]$', '$1');
        if strcmp(key, 'mfilename')
            value = regexprep(value, '\.m$', '');
        end
        if any(strcmp(key, {'collisions', 'problem type'}))
            value = lower(strtok(value));
        end
        if isempty(value)
            error('nekton:bht:value', '%s: %s has no value', where, key);
        end
    else
        value = number(raw, key, where);
        sizes = struct('initial_position', 3, 'initial_velocity', 3, 'settings', NaN, 'hinge_coord', 2, 'hinge_local_coord', 2);
        expected = 1;
        if isfield(sizes, field)
            expected = sizes.(field);
        end
        if numel(value) ~= expected && ~isnan(expected)
            error('nekton:bht:value', '%s: %s must have %d elements, not %d', where, key, expected, numel(value));
        end
        if strcmp(field, 'settings')
            value = value(:)';
        else
            value = value(:);
        end
    end
    if isfield(found, field)
        warning('nekton:bht:ignored', '%s: %s is given twice; the later one holds', where, key);
    end
    found.(field) = value;
    from = last + 1;
end
end

function last = closing(text, start, where)
% The brace that closes the one at start.
depth = cumsum((text(start:end) == '{') - (text(start:end) == '}'));
last = find(depth == 0, 1) + start - 1;
if isempty(last)
    error('nekton:bht:syntax', '%s: a { is never closed', where);
end
end

function last = value_end(text, start)
% A value ends before a newline, ; or } outside of brackets.
depth = 0;
last = start - 1;
for k = start:numel(text)
    c = text(k);
    depth = depth + any(c == '[(') - any(c == '])');
    if depth <= 0 && any(c == sprintf('\r\n;}'))
        return
    end
    last = k;
end
end

function value = number(raw, key, where)
% Words behind the expression are a comment.
ends = [numel(raw), fliplr(find(isspace(raw)) - 1)];
for k = ends
    value = evaluated(raw(1:k));
    if ~isempty(value)
        return
    end
end
error('nekton:bht:value', '%s: %s = %s is not a number', where, key, raw);
end

function value_ = evaluated(expression_)
% The value of an expression that is real and finite, else [].
value_ = [];
try
    value_ = eval(['[' expression_ ']']);
catch
end
if ~isnumeric(value_) || ~isreal(value_) || ~all(isfinite(value_(:)))
    value_ = [];
end
value_ = double(value_);
end

function s = defaults(s, table, where)
% Missing fields get their default, with a warning.
for k = 1:size(table, 1)
    if ~isfield(s, table{k, 1})
        s.(table{k, 1}) = table{k, 2};
        value = table{k, 2};
        if ~ischar(value)
            value = mat2str(value);
        end
        warning('nekton:bht:missing', '%s: %s is missing; it is taken as %s', where, strrep(table{k, 1}, '_', ' '), value);
    end
end
end

function s = quiet(s, table)
for k = 1:size(table, 1)
    if ~isfield(s, table{k, 1})
        s.(table{k, 1}) = table{k, 2};
    end
end
end

function list = items(s, field)
list = {};
if isfield(s, field)
    list = s.(field);
end
end

function n = nodes(part)
n = part.number_of_points;
if isempty(n)
    n = 64;
    if strcmp(part.mfilename, 'bht_round_rectangle')
        n = 128;
    end
end
end

function [shape, at, centroid] = boundary(part, where)
% Shape about its own origin, where that lies in the frame of drawing, and the centroid there.
s = part.settings;
lengths = struct('bht_ellipse', 5, 'bht_round_rectangle', 6);
if isfield(lengths, part.mfilename) && numel(s) ~= lengths.(part.mfilename)
    error('nekton:bht:value', '%s: %s takes %d settings, not %d', where, part.mfilename, lengths.(part.mfilename), numel(s));
end
switch part.mfilename
    case 'bht_ellipse'
        shape = struct('ellipse', abs(s(3:4)));
        at = s(1:2);
        centroid = at;
    case 'bht_round_rectangle'
        shape = struct('rectangle', abs(s(3:4)), 'radius', s(5));
        at = s(1:2);
        centroid = at;
    otherwise
        if isempty(which(part.mfilename))
            error('nekton:bht:boundary', '%s: there is no function %s', where, part.mfilename);
        end
        n = nodes(part);
        f = str2func(part.mfilename);
        points = f((0:n - 1) * 2 * pi / n, 0, s);
        if ~isnumeric(points) || ~isequal(size(points), [2, n]) || ~all(isfinite(points(:)))
            error('nekton:bht:boundary', '%s: %s must give 2 x n finite numbers', where, part.mfilename);
        end
        shape = struct('curve', points', 'corners', 'none');
        at = [0 0];
        t = (0:2047) * 2 * pi / 2048;
        [~, centroid] = bht_area(f(t, 0, s), f(t, 1, s));
end
end

function template(name, joints)
% Writes a controls M-file to be filled in.
name = regexprep(name, '\.m$', '');
file = [name '.m'];
if exist(file, 'file') == 2
    warning('nekton:bht:ignored', '%s is there already; no template is written', file);
    return
end
[~, word] = fileparts(name);
id = fopen(file, 'w');
if id < 0
    error('nekton:bht:file', '%s cannot be written', file);
end
n = numel(joints);
fprintf(id, 'function [c, dc, dttc] = %s(t, cont_parameters)\n', word);
fprintf(id, '%% Angles of the hinges, rad, and their first and second derivative at time t: columns.\n');
for k = 1:n
    fprintf(id, '%%   c(%d): %s\n', k, joints{k});
end
fprintf(id, '%% If dc is not 0 at t = 0 the body may drift: its initial velocity then does not mean that all of it is at rest.\n');
fprintf(id, 'c = zeros(%d, 1);\ndc = zeros(%d, 1);\ndttc = zeros(%d, 1);\nend\n', n, n, n);
fclose(id);
rehash();
end
