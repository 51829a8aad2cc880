function test_dat_file()
% DAT-files: every key is read, expressions too; missing and unknown fields are reported; two_eggs.dat gives the reference
% values, and the energies add up exactly.
here = fileparts(fileparts(mfilename('fullpath')));
folder = tempname();
mkdir(folder);
back = cd(folder);
home = onCleanup(@() leave(back, folder));
warning('off', 'nekton:bht:missing');

bht_traject_compute('DataFilename', fullfile(here, 'examples', 'two_eggs.dat'), 'Tolerance', 1e-11);
r = load('two_eggs_results.mat');
near(r.Q(end, :), [7.2064755992337, -1.1070979855674, -1.2591097272845, -2.8584118752586, 7.6710947047387, 0.8190183042321], 1e-9);
near([numel(r.T), r.T(end)], [101, 10], 1e-12);
[T, E_tot, E_fl, E_fi, E_pot, E_def, E_net, torques, power] = bht_energy('DataFilename', 'two_eggs');
near(T, r.T, 0);
assert(isequal(E_fi, E_net + E_def) && isequal(E_tot, E_fl + E_fi));
near(E_fi, r.E_fi, 1e-13);
near(E_def, zeros(size(T)), 1e-13);
near(E_tot, E_tot(1) * ones(size(T)), 1e-9);
assert(isempty(E_pot) && isempty(torques) && isempty(power));

put('all.dat', {'This scene has everything. fluid  density=2*1.5 max time = 4 time step = 1/2', 'gravity = 9.81', ...
    'collisions = yes alpha = 3', 'epsilon = 0.02; number of points = 48', '% max time = 77', ...
    'fish = { initial position = [1; 2;', ' pi/3] initial velocity = [0.1, 0.2, 0.3] the words here are a comment', ...
    '  link = { label = head  mfilename = bht_round_rectangle settings = [0 0 2 1 0.2 1] solid density = 3 }', ...
    '  link = { label = tail father = head mfilename = bht_ellipse', ...
    '    hinge coord = [-1.2; 0] hinge local coord = [0.9, 0] settings = [0.5 0 0.8 0.3 -1] number of points = 32 } }', ...
    'obstacle = { mfilename = bht_ellipse settings = [0 -5 1 1 1] }', ...
    'tank = { mfilename = bht_ellipse settings = [0 0 20 20 -1] number of points = 64}'});
[g, scene] = bht_data_compile('all', 'ControlsFilename', 'all_controls');
near([g.fluid_density, g.max_time, g.time_step, g.gravity, g.alpha, g.epsilon], [3, 4, 0.5, 9.81, 3, 0.02], 0);
near(g.fish{1}.initial_position, [1; 2; pi / 3], 0);
near(g.fish{1}.initial_velocity, [0.1; 0.2; 0.3], 0);
assert(g.fish{1}.link{1}.density == 3 && strcmp(g.fish{1}.link{2}.father, 'head'));
near(scene.body{1}.link{2}.hinge.parent, [-1.2 0], 0);
near(scene.body{1}.link{2}.hinge.self, [0.9 0], 0);
assert(scene.body{1}.link{2}.nodes == 32 && scene.tank.nodes == 64 && scene.obstacle{1}.nodes == 48);
[~, drawn] = bht_data_compile('DataFilename', 'all.dat', 'HingeFrames', 'drawing');
near(drawn.body{1}.link{2}.hinge.self, [0.4 0], 1e-12);
[c, dc, ddc] = all_controls(0, []);
assert(isequal(c, 0) && isequal(dc, 0) && isequal(ddc, 0));
sim = Nekton(scene, 'controls', @(t) all_controls(t, []), 'tolerance', 1e-6);
q = sim.positions();
near(q(1:2, 1), [1; 2], 1e-14);
sim.advance(0.1);
delete(sim);
raises('nekton:bht:controls', @() bht_traject_compute('all'));
r = bht_traject_compute('all', 'ControlsFilename', 'all_controls', 'Tolerance', 1e-6, 'ResultsFilename', '');
total = r.E_fl + r.E_fi + r.E_pot + r.E_rep;
near(total / total(1), ones(9, 1), 1e-3);

% What is not understood is reported; what cannot be used is an error.
put('odd.dat', {'fluid density = 1', 'viscosity = 3', 'fish = { link = { colour = { red = 1 } settings = [0 0 1 1 1] } }'});
lastwarn('', '');
warnings = evalc('bht_data_compile(''odd'')');
assert(~isempty(strfind(warnings, 'viscosity')) && ~isempty(strfind(warnings, 'colour')));
warning('on', 'nekton:bht:missing');
warnings = evalc('bht_data_compile(''odd'')');
assert(~isempty(strfind(warnings, 'max time is missing')) && ~isempty(strfind(warnings, 'initial position is missing')));
warning('off', 'nekton:bht:missing');
raises('nekton:bht:file', @() bht_data_compile('no_such'));
raises('nekton:bht:file', @() bht_energy('DataFilename', 'no_such'));
raises('nekton:bht:option', @() bht_data_compile('DataFilename', 'odd', 'Speed', 1));
for bad = {'max time = ten', 'fish = 3', 'fish = { link = {', 'fish = { initial position = [1 2] link = {} }', ...
        'fish = { link = { father = nobody } }', 'collisions = perhaps', 'fish = { link = { mfilename = no_such_shape } }', ...
        'max time = NaN'}
    put('bad.dat', bad);
    try
        bht_data_compile('bad');
    catch problem
        assert(strncmp(problem.identifier, 'nekton:bht:', 11), '%s: %s', bad{1}, problem.message);
        continue
    end
    error('nekton:test:silent', 'no error for: %s', bad{1});
end

% An own boundary, sampled, is as good as the exact shape.
put('own_shape.m', {'function [y, varargout] = own_shape(t, der, settings)', 'y = bht_ellipse(t, der, settings);', 'end'});
text = {'max time = 1 time step = 0.5 fish = { initial velocity = [1 0 1] link = { mfilename = SHAPE settings = [0.3 0 1 0.5 -1] } }'};
put('exact.dat', strrep(text, 'SHAPE', 'bht_ellipse'));
put('own.dat', strrep(text, 'SHAPE', 'own_shape'));
warning('off', 'nekton:scene:notice');
exact = bht_traject_compute('exact', 'ResultsFilename', '');
own = bht_traject_compute('own', 'ResultsFilename', '');
near(own.Q, exact.Q, 1e-7);

% A fluid of density 0: the swimmer's centre of mass stays.
put('vacuum.dat', {'fluid density = 0 max time = 3 time step = 0.5', ...
    'fish = { link = { label = a settings = [0 0 1 0.3 1] } link = { label = b father = a settings = [0 0 1 0.3 1]', ...
    'hinge coord = [-1.1 0] hinge local coord = [1.1 0] } }'});
wave = @(t, p) deal(p * sin(t)^3, 3 * p * sin(t)^2 * cos(t), 6 * p * sin(t) * cos(t)^2 - 3 * p * sin(t)^3);
r = bht_traject_compute('vacuum', 'ControlsFilename', wave, 'ControlsParameters', 0.5);
near((r.Q(:, 1:2) + r.Q(:, 4:5)) / 2, ones(7, 1) * [-1.1 0], 1e-8);
near(r.C, 0.5 * sin(r.T).^3, 1e-9);
[~, ~, ~, E_fi, ~, E_def, E_net, torques, power] = bht_energy('DataFilename', 'vacuum');
assert(isequal(E_fi, E_net + E_def) && max(E_def) > 0.01);
near(E_fi, r.E_fi, 1e-12);
near(E_net, zeros(7, 1), 1e-12);
near(power, torques .* r.DC, 1e-12);
warning('on', 'nekton:scene:notice');
warning('on', 'nekton:bht:missing');
end

function put(name, lines)
id = fopen(name, 'w');
fprintf(id, '%s\n', lines{:});
fclose(id);
rehash();
end

function leave(back, folder)
cd(back);
for file = dir(folder)'
    if ~file.isdir
        delete(fullfile(folder, file.name));
    end
end
rmdir(folder);
end
