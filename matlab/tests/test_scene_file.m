function test_scene_file()
% Scene files are read as JSON and, with Python, as TOML: every scene of the project that has no separate tables starts here.
file = [tempname() '.json'];
id = fopen(file, 'w');
fprintf(id, ['{"fluid": {"density": 2}, "body": [{"name": "fish", "position": [1, 2], "velocity": [0.1, 0], "link": [' ...
    '{"name": "tail", "parent": "head", "shape": {"ellipse": [0.8, 0.2]}, "density": 1, "hinge": {"parent": [-1.1, 0], ' ...
    '"self": [0.9, 0]}, "motion": {"harmonic": [{"amplitude": 0.5, "frequency": 2, "phase": 0.2}], ' ...
    '"window": {"from": 0, "to": 9, "ramp": 2}}}, {"name": "head", "shape": {"ellipse": [1, 0.35]}, "density": 1}]}, ' ...
    '{"position": [6, 2], "link": [{"shape": {"star": {"radius": 0.5, "amplitude": 0.1, "lobes": 3}}, "mass": 1, "inertia": 0.2}]}], ' ...
    '"run": {"integrator": {"method": "rk4", "step": 0.05}}}']);
fclose(id);
sim = Nekton(file);
delete(file);
assert(strcmp(sim.links(1).name, 'fish.head') && strcmp(sim.jointNames{1}, 'fish.tail') && sim.links(3).mass == 1);
q = sim.positions();
near(q(:, 1), [1; 2; 0], 1e-14);
sim.step();
near(sim.time(), 0.05, 1e-15);
delete(sim);

[status, ~] = system('python3 -c "import tomllib" 2>&1');
if status ~= 0
    fprintf('SKIPPED: TOML, as there is no Python 3.11\n');
    return
end
folder = fullfile(fileparts(fileparts(fileparts(mfilename('fullpath')))), 'scenes');
files = dir(fullfile(folder, '*.toml'));
assert(numel(files) > 5);
for k = 1:numel(files)
    text = fileread(fullfile(folder, files(k).name));
    if isempty(regexp(text, '(^|\n)[^#\n]*"[^"\n]*\.csv"', 'once'))
        sim = Nekton(fullfile(folder, files(k).name));
        e = sim.energy();
        assert(isfinite(e.total));
        delete(sim);
    end
end
end
