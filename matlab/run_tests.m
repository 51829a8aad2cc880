function run_tests(varargin)
%RUN_TESTS  Run all tests, or those named: run_tests('test_handles').
%   Each file tests/test_*.m is a function that fails by an error. The error nekton:test:fail is raised at the end if any failed.

here = fileparts(mfilename('fullpath'));
addpath(here, fullfile(here, 'tests'));
names = varargin;
if isempty(names)
    files = dir(fullfile(here, 'tests', 'test_*.m'));
    names = sort(strrep({files.name}, '.m', ''));
end
warning('off', 'Octave:gnuplot-graphics');
failed = 0;
for k = 1:numel(names)
    start = tic();
    try
        feval(names{k});
        fprintf('%-32s %6.1f s  passed\n', names{k}, toc(start));
    catch problem
        failed = failed + 1;
        fprintf('%-32s %6.1f s  FAILED: %s (%s)\n', names{k}, toc(start), problem.message, problem.identifier);
        for s = problem.stack(:)'
            fprintf('    %s line %d\n', s.name, s.line);
        end
    end
    close('all');
    live = nekton_mex('live');
    if live ~= 0
        failed = failed + 1;
        fprintf('%-32s FAILED: left %d simulations behind\n', names{k}, live);
    end
end
fprintf('%d of %d tests passed\n', numel(names) - min(failed, numel(names)), numel(names));
if failed > 0
    error('nekton:test:fail', '%d failed', failed);
end
end
