function test_handles()
% Invalid, freed and foreign handles are refused; clear, clear all and exit are survived; two models live side by side.
count = @() nekton_mex('live');
assert(count() == 0);
one = Nekton(eggs());
two = Nekton(swimmer(struct('locked', 0.3)));
assert(count() == 2);
one.step();
two.step();
one.advance(0.5);
assert(two.time() ~= one.time());
near(numel(two.positions()), 6, 0);
clear two
assert(count() == 1);
delete(one);
assert(count() == 0);
raises('nekton:handle:stale', @() one.step());
clear one

method = {'adams', [0 1e-9 1e-9 0 0]};
scene = nekton_scene(eggs());
h = nekton_mex('create', scene, method{:});
assert(isa(h, 'uint64') && mislocked('nekton_mex'));
clear nekton_mex
assert(nekton_mex('time', h) == 0);
nekton_mex('step', h);
nekton_mex('free', h);
assert(~mislocked('nekton_mex'));
g = nekton_mex('create', scene, method{:});
assert(g ~= h);
for command = {'free', 'step', 'time', 'positions', 'energy', 'plan', 'mass_matrix'}
    raises('nekton:handle:stale', @() nekton_mex(command{1}, h));
end
assert(nekton_mex('time', g) == 0);
raises('nekton:handle:class', @() nekton_mex('time', double(g)));
raises('nekton:handle:class', @() nekton_mex('time', [g g]));
raises('nekton:handle:class', @() nekton_mex('time', 'x'));
raises('nekton:handle:invalid', @() nekton_mex('time', uint64(0)));
raises('nekton:handle:invalid', @() nekton_mex('time', uint64(5000)));
raises('nekton:handle:stale', @() nekton_mex('time', uint64(7)));
raises('nekton:handle:stale', @() nekton_mex('time', intmax('uint64') - uint64(4294967295) + uint64(3)));
nekton_mex('free', g);
raises('nekton:handle:stale', @() nekton_mex('free', g));

% In a program of their own: clear all with an object alive, and exit with one.
if exist('OCTAVE_VERSION', 'builtin')
    here = fileparts(fileparts(mfilename('fullpath')));
    code = ['addpath(pwd, ''tests''); s = Nekton(eggs()); s.step(); clear all; ' ...
        'assert(nekton_mex(''live'') == 0); s = Nekton(eggs()); s.step(); ' ...
        'h = nekton_mex(''create'', nekton_scene(eggs()), ''adams'', [0 1e-9 1e-9 0 0]); disp(''fine'')'];
    program = fullfile(OCTAVE_HOME(), 'bin', 'octave-cli');
    [status, output] = system(sprintf('cd "%s" && "%s" --norc --no-history --quiet --eval "%s" 2>&1', here, program, code));
    assert(status == 0 && strcmp(strtrim(output), 'fine'), 'exit: status %d, %s', status, output);
end
end
