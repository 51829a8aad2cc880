function test_fish_dat()
% fish.dat with its controls: the fish swims as the fish of the reference does, its energy is the work of its hinges, and
% it stops dead.
here = fileparts(fileparts(mfilename('fullpath')));
addpath(fullfile(here, 'examples'), fullfile(here, 'reference'));
amplitudes = [0.4; 0.6; 0.8];
figure('visible', 'off');
assert(bht_controls_check('fish_controls', 20, amplitudes));
r = bht_traject_compute('DataFilename', fullfile(here, 'examples', 'fish.dat'), 'ControlsFilename', 'fish_controls', ...
    'ControlsParameters', amplitudes, 'ResultsFilename', '');
[~, ~, t_end, own] = reference_scenes('fish', 64);
sim = Nekton(own, 'tolerance', 1e-9);
sim.advance(t_end);
q = sim.positions();
near(r.T(end), t_end, 1e-12);
near(r.Q(end, 1:3), q(:, 1), 1e-6);
near(r.V(end, :), zeros(1, 12), 1e-12);
near(r.power, r.torques .* r.DC, 1e-12);
% d/dt (energy) = power, integrated by the trapezoidal rule from rest to rest (of any order there).
near(sum(sum(r.power)) * 0.1, 0, 1e-6);
middle = 1:101;
work = cumsum(sum(r.power(middle, :), 2)) * 0.1;
energy = r.E_fl(middle) + r.E_fi(middle);
near(work(end) - 0.05 * sum(r.power(101, :)), energy(end), 1e-3); % measured 1e-4, the rule's own error
end
