function [y, evaluations] = reference_solve(scene, y, t, tolerance)
%REFERENCE_SOLVE  State at the last of the times t by a solver of Adams type: ode113 in Matlab, lsode in Octave.
%   Steps are at most 1, so that none jumps over a stroke that begins slowly.
counter = containers.Map({'n'}, {0});
if exist('OCTAVE_VERSION', 'builtin')
    lsode_options('integration method', 'adams');
    lsode_options('relative tolerance', tolerance);
    lsode_options('absolute tolerance', tolerance);
    lsode_options('maximum step size', 1);
    Y = lsode(@(y, t) rate(t, y, scene, counter), y, t);
    lsode(@(y, t) 0, 0, [0 1]); % forgets the function
else
    [~, Y] = ode113(@(t, y) rate(t, y, scene, counter), t, y, odeset('RelTol', tolerance, 'AbsTol', tolerance, 'MaxStep', 1));
end
y = Y(end, :)';
evaluations = counter('n');
end

function dy = rate(t, y, scene, counter)
counter('n') = counter('n') + 1;
dy = reference_rhs(t, y, scene);
end
