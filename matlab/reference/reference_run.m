function reference_run(nodes, tolerance, t_end)
%REFERENCE_RUN  Runs the scene two_ellipses by the reference and prints processor time (s), evaluations and final positions in
%   one line: what `cargo xtask bench` compares nekton with.
[scene, y] = reference_scenes('two_ellipses', nodes);
reference_rhs(0, y, scene);
start = cputime();
[y, evaluations] = reference_solve(scene, y, [0 t_end], tolerance, 'adams');
fprintf('%.6g %d%s\n', cputime() - start, evaluations, sprintf(' %.17g', y(1:6)));
end
