function results = bht_traject_compute(varargin)
%BHT_TRAJECT_COMPUTE  Compute the motion described by a DAT-file; write NAME_results.mat.
%   BHT_TRAJECT_COMPUTE('DataFilename', name) or BHT_TRAJECT_COMPUTE(name) writes the MAT-file name_results in the present folder.
%   results = ... gives its content as a struct.
%
%   Options (the old ones are not public; these are our choice)
%     'ControlsFilename', f     controls M-file [c, dc, dttc] = f(t, cont_parameters), a name or a function handle
%     'ControlsParameters', p   its second argument ([] unless given)
%     'ControlsStep', h         time between two calls of it (time step / 8 unless given): the angles are quintic in between
%     'Tolerance', tol          of the integrator, relative and absolute (1e-9)
%     'HingeFrames', frames     see bht_data_compile
%     'ResultsFilename', r      another name than name_results; '' writes no file
%
%   Fields of the results, by time step (rows):
%     T               times 0, time step, ..., max time
%     Q, V            x, y, theta of the centre of mass of every link, and their rates
%     C, DC           hinge angles and their rates
%     E_fl, E_fi      kinetic energy of the fluid, of the bodies;  E_pot of buoyancy;  E_rep of repulsion
%     torques, power  of every hinge
%   and gene_data, links, scene, cpu (seconds).

options = bht_options(struct('DataFilename', '', 'ControlsFilename', '', 'ControlsParameters', [], 'ControlsStep', [], ...
    'Tolerance', 1e-9, 'HingeFrames', 'centroid', 'ResultsFilename', []), varargin{:});
[gene_data, scene] = bht_data_compile('DataFilename', options.DataFilename, 'HingeFrames', options.HingeFrames);
dt = gene_data.time_step;
if ~(dt > 0 && gene_data.max_time > 0)
    error('nekton:bht:value', 'max time and time step must be positive');
end
T = (0:floor(gene_data.max_time / dt + 1e-9))' * dt;
f = options.ControlsFilename;
if ischar(f) && ~isempty(f)
    f = str2func(regexprep(f, '\.m$', ''));
end
joints = numel(gene_data.joints);
if joints > 0 && isempty(f)
    error('nekton:bht:controls', 'there are %d hinges: give ControlsFilename', joints);
end
if joints > 0
    scene = moved(scene, f, options, T(end), dt, joints);
end

start = tic();
sim = Nekton(scene, 'tolerance', options.Tolerance);
n = numel(T);
links = numel(sim.links);
results = struct('T', T, 'Q', zeros(n, 3 * links), 'V', zeros(n, 3 * links), 'C', zeros(n, joints), 'DC', zeros(n, joints), ...
    'E_fl', zeros(n, 1), 'E_fi', zeros(n, 1), 'E_pot', zeros(n, 1), 'E_rep', zeros(n, 1), 'torques', zeros(n, joints), ...
    'power', zeros(n, joints));
for k = 1:n
    sim.show(T(k), T(end));
    results.Q(k, :) = reshape(sim.positions(), 1, []);
    results.V(k, :) = reshape(sim.velocities(), 1, []);
    e = sim.energy();
    results.E_fl(k) = e.kinetic_fluid;
    results.E_fi(k) = e.kinetic_bodies;
    results.E_pot(k) = e.buoyancy;
    results.E_rep(k) = e.repulsion;
    if joints > 0
        [u, du] = sim.joints();
        [torque, power] = sim.torques();
        results.C(k, :) = u';
        results.DC(k, :) = du';
        results.torques(k, :) = torque';
        results.power(k, :) = power';
    end
end
results.cpu = toc(start);
results.gene_data = gene_data;
results.links = sim.links;
results.scene = scene;
delete(sim);

name = options.ResultsFilename;
if ~ischar(name)
    [~, base] = fileparts(regexprep(options.DataFilename, '\.dat$', ''));
    name = [base '_results'];
end
if ~isempty(name)
    save(bht_mat(name), '-struct', 'results');
end
end

function scene = moved(scene, f, options, t_end, dt, joints)
% The hinges' motion as tables of what the controls give.
h = options.ControlsStep;
if isempty(h)
    h = dt / 8;
end
count = max(1, ceil(t_end / h - 1e-9));
times = (0:count) * h;
rows = zeros(numel(times), 4, joints);
for k = 1:numel(times)
    [c, dc, ddc] = f(times(k), options.ControlsParameters);
    if numel(c) ~= joints || numel(dc) ~= joints || numel(ddc) ~= joints
        error('nekton:bht:controls', 'the controls must be three columns of %d', joints);
    end
    for j = 1:joints
        rows(k, :, j) = [times(k), c(j), dc(j), ddc(j)];
    end
end
j = 0;
for b = 1:numel(scene.body)
    for l = 1:numel(scene.body{b}.link)
        if isfield(scene.body{b}.link{l}, 'hinge')
            j = j + 1;
            scene.body{b}.link{l}.motion = struct('table', rows(:, :, j));
        end
    end
end
end
