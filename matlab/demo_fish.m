function demo_fish(varargin)
%DEMO_FISH  A fish of four ellipses swims; its energies and the torques in its joints are plotted.
%   demo_fish          animates on the screen, then plots (without a screen: nothing is shown while it runs)
%   demo_fish(folder)  writes the animation's frames and the plots fish.png as files into a folder
%
%   The joint angles come from a function of time (below), infinitely smooth and different from zero on [0, 6 pi] only. When
%   they end the fish stands still: alone in an ideal fluid there is no gliding.

folder = '';
if nargin > 0
    folder = varargin{1};
    if exist(folder, 'dir') ~= 7
        mkdir(folder);
    end
end
density = 1;
link = @(name, a, b) struct('name', name, 'shape', struct('ellipse', [a b]), 'density', density, 'nodes', 64);
links = {link('head', 1.0, 0.35), link('front', 0.9, 0.32), link('rear', 0.8, 0.25), link('tail', 0.8, 0.14)};
fathers = [1.1, 1.0, 0.9];  % from the centroid of the father back to the hinge
own = [1.0, 0.9, 0.9];      % from the hinge back to the link's own centroid
for k = 1:3
    links{k + 1}.parent = links{k}.name;
    links{k + 1}.hinge = struct('parent', [-fathers(k) 0], 'self', [own(k) 0]);
end
scene = struct('body', struct('name', 'fish', 'link', {links}));
sim = Nekton(scene, 'controls', @stroke, 'method', 'rk4', 'step', 0.05, 'control_step', 0.05);

times = 0:0.1:20;
n = numel(times);
energies = zeros(n, 3);
torques = zeros(n, 3);
path = zeros(n, 2);
show = figure('visible', visibility(folder));
for k = 1:n
    sim.advance(times(k));
    e = sim.energy();
    energies(k, :) = [e.kinetic_fluid, e.kinetic_bodies, e.total];
    torques(k, :) = sim.torques()';
    q = sim.positions();
    path(k, :) = q(1:2, 1)';
    if mod(k, 4) == 1 && (~isempty(folder) || ~isempty(getenv('DISPLAY')) || ispc() || ismac())
        sim.plot([-8 4 -3 3]);
        if isempty(folder)
            drawnow();
        else
            nekton_print(show, fullfile(folder, sprintf('frame_%04d.png', (k + 3) / 4)));
        end
    end
end
left = max(max(abs(sim.velocities())));
fprintf('the head went from x = %.3f to %.3f; largest speed left: %.1e\n', path(1, 1), path(n, 1), left);
fprintf('work done by the joints over the stroke: %.1e (largest energy %.3f)\n', energies(n, 3), max(energies(:, 3)));

plots = figure('visible', visibility(folder));
subplot(3, 1, 1);
plot(times, path(:, 1));
ylabel('x of the head');
subplot(3, 1, 2);
plot(times, energies);
legend('fluid', 'bodies', 'total', 'location', 'northwest');
ylabel('kinetic energy');
subplot(3, 1, 3);
plot(times, torques);
legend('front', 'rear', 'tail', 'location', 'northwest');
ylabel('torque');
xlabel('t');
if ~isempty(folder)
    nekton_print(plots, fullfile(folder, 'fish.png'));
    close(show);
    close(plots);
end
end

function v = visibility(folder)
v = 'on';
if ~isempty(folder)
    v = 'off';
end
end

function [c, dc, ddc] = stroke(t)
% amplitude sin(t + phase) times a window that rises over 2 pi, stays at 1 and falls from 4 pi to 6 pi
amplitude = [0.4; 0.6; 0.8];
phase = [0; -1.2; -2.4];
[w, dw, ddw] = bht_step2(t, 2 * pi, 6 * pi);
s = amplitude .* sin(t + phase);
ds = amplitude .* cos(t + phase);
c = w * s;
dc = dw * s + w * ds;
ddc = ddw * s + 2 * dw * ds - w * s;
end
