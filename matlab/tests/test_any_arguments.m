function test_any_arguments()
% Every command with arguments of every kind either works or raises an error of its own; the program survives.
commands = {'create', 'free', 'live', 'plan', 'links', 'joints', 'notices', 'outline', 'time', 'state', 'set_state', 'restart', ...
    'step', 'advance', 'advance_dense', 'channels', 'rhs', 'positions', 'velocities', 'joint_values', 'torques', 'energy', ...
    'impulse', 'resolution', 'indicators', 'time_error', 'gap', 'counters', 'accelerations', 'mass_matrix', 'added_mass', 'christoffel', 'buoyancy', ...
    'repulsion', 'circulation', 'gyroscopic', 'linearize'};
scene = nekton_scene(swimmer('control'));
method = {'adams', [0 1e-6 1e-6 0 0]};
broken = scene;
broken.bodies.links = 3;
hollow = scene;
hollow.bodies.links(1).shape = [];
things = {[], {}, '', 'x', 'link', 'adams', 0, 1, -1, NaN, Inf, 1e300, 1i, single(1), int8(1), true, sparse(1), uint64(0), ...
    uint64(1), zeros(0, 3), [0 1e-6 1e-6 0 0], [1 0], [3 1 0], [7 1 0; 5 2 3], [1e9 1e9 1e9], [0.1 0 0 0 0], ones(5, 1), ones(2, 2, 2), struct(), struct('bodies', []), ...
    {1, 2}, @sin, scene, broken, hollow, NaN(5, 1), [struct('a', 1), struct('a', 2)]};
rand('twister', 1);
alive = {};
for k = 1:4000
    command = commands{ceil(rand() * numel(commands))};
    if isempty(alive) || rand() < 0.01
        alive{end + 1} = nekton_mex('create', scene, method{:}); %#ok<AGROW>
    end
    arguments = cell(1, floor(rand() * 6));
    for j = 1:numel(arguments)
        arguments{j} = things{ceil(rand() * numel(things))};
    end
    if rand() < 0.7 && ~isempty(arguments)
        arguments{1} = alive{ceil(rand() * numel(alive))};
    end
    try
        nekton_mex(command, arguments{:});
    catch problem
        assert(strncmp(problem.identifier, 'nekton:', 7), '%s: %s (%s)', command, problem.message, problem.identifier);
    end
end
for k = 1:numel(alive)
    try
        nekton_mex('free', alive{k});
    catch problem
        assert(strcmp(problem.identifier, 'nekton:handle:stale'));
    end
end
end
