function [y, evaluations] = reference_solve(scene, y, t, tolerance, solver)
%REFERENCE_SOLVE  State at the last of the times t by 'ode45' or by a solver of Adams type, 'adams': ode113 in Matlab,
%   lsode in Octave. (Use ode45 for the fish: lsode left errors of 0.1 at some tolerances, for a reason not found.)
counter = containers.Map({'n'}, {0});
f = @(t, y) rate(t, y, scene, counter);
options = odeset('RelTol', tolerance, 'AbsTol', tolerance, 'MaxStep', 1);
if strcmp(solver, 'ode45')
    [~, Y] = ode45(f, t, y, options);
elseif exist('OCTAVE_VERSION', 'builtin')
    lsode_options('integration method', 'adams');
    lsode_options('relative tolerance', tolerance);
    lsode_options('absolute tolerance', tolerance);
    Y = lsode(@(y, t) f(t, y), y, t);
    lsode(@(y, t) 0, 0, [0 1]); % forgets the function
else
    [~, Y] = ode113(f, t, y, options);
end
y = Y(end, :)';
evaluations = counter('n');
end

function dy = rate(t, y, scene, counter)
counter('n') = counter('n') + 1;
dy = reference_rhs(t, y, scene);
end
