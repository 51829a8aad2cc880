function [y, evaluations] = reference_solve(scene, y, t, tolerance)
%REFERENCE_SOLVE  State at the last of the times t by a solver of Adams type: ode113 in Matlab, lsode in Octave.
counter = struct('n', 0);
function dy = rate(t, y)
    counter.n = counter.n + 1;
    dy = reference_rhs(t, y, scene);
end
if exist('OCTAVE_VERSION', 'builtin')
    lsode_options('integration method', 'adams');
    lsode_options('relative tolerance', tolerance);
    lsode_options('absolute tolerance', tolerance);
    Y = lsode(@(y, t) rate(t, y), y, t);
    lsode(@(y, t) 0, 0, [0 1]); % forgets the function
else
    [~, Y] = ode113(@rate, t, y, odeset('RelTol', tolerance, 'AbsTol', tolerance));
end
y = Y(end, :)';
evaluations = counter.n;
end
