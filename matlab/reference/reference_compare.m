function reference_compare()
%REFERENCE_COMPARE  Results and speed of nekton and of the reference (reference_rhs), in one run.
%   Each solves the scenes two_ellipses and fish with several numbers of nodes (nekton crowds them near contact and needs fewer) and
%   tolerances; of the runs of each whose final position of the first link is right to the accuracy asked for, the fastest counts.

here = fileparts(mfilename('fullpath'));
addpath(here, fileparts(here));
reference_compare_scene('two_ellipses', 1e-5, 'adams', {[16 24 32 48], [80 96 128]}, [1e-6 1e-7 1e-8 1e-9], [-4.4566299139; -0.0703918602; 2.6164405953]);

[~, ~, t_end, own] = reference_scenes('fish', 96);
sim = Nekton(own, 'tolerance', 1e-8);
sim.advance(t_end);
q = sim.positions();
reference_compare_scene('fish', 1e-3, 'ode45', {[12 16 24 32], [48 64 80]}, [1e-4 1e-5], q(:, 1));
end

function reference_compare_scene(name, accuracy, solver, nodes, tolerances, exact)
fprintf('%s, final position to %.0e\n', name, accuracy);
fprintf('  %-10s %6s %10s %10s %12s %9s\n', '', 'nodes', 'tolerance', 'error', 'evaluations', 'time, s');
best = [Inf, Inf];
tools = {'nekton', 'reference'};
for tool = 1:2
    for n = nodes{tool}
        for tolerance = tolerances
            [scene, y, t_end, own] = reference_scenes(name, n);
            start = tic();
            if tool == 1
                sim = Nekton(own, 'tolerance', tolerance);
                sim.advance(t_end);
                q = sim.positions();
                evaluations = sim.counters();
                evaluations = evaluations.evaluations;
            else
                [q, evaluations] = reference_solve(scene, y, [0 t_end], tolerance, solver);
            end
            time = toc(start);
            wrong = max(abs(reshape(q(1:3), [], 1) - exact));
            fprintf('  %-10s %6d %10.0e %10.1e %12d %9.3f\n', tools{tool}, n, tolerance, wrong, evaluations, time);
            if wrong <= accuracy
                best(tool) = min(best(tool), time);
            end
        end
    end
end
fprintf('  fastest: nekton %.3f s, reference %.2f s, ratio %.1f\n', best, best(2) / best(1));
end
