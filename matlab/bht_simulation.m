function files = bht_simulation(varargin)
%BHT_SIMULATION  Movie of a computed motion.
%   BHT_SIMULATION('DataFilename', name) draws the motion in name_results, which bht_traject_compute wrote, on the screen.
%
%   Options (the old ones are not public; these are our choice)
%     'Output', 'movie.gif'   writes an animated GIF;   'Output', folder   writes frame_0001.png, ... there
%     'Axis', [x0 x1 y0 y1]   limits (all that moves, unless given)
%     'Every', k              every k-th time step (1)
%
%   files = ... the names of the files written.

options = bht_options(struct('DataFilename', '', 'Output', '', 'Axis', [], 'Every', 1), varargin{:});
r = bht_results(options.DataFilename);
sim = Nekton(r.scene);
t = linspace(0, 2 * pi, 100);
t(end) = 0;
[~, walls] = sim.outlines(100);
n = numel(sim.links);
shapes = cell(1, n);
reach = 0;
for k = 1:n
    shapes{k} = sim.outline('link', sim.links(k).body, sim.links(k).link, t);
    reach = max(reach, max(sqrt(sum(shapes{k}.^2, 1))));
end
limits = options.Axis;
if isempty(limits)
    x = r.Q(:, 1:3:end);
    y = r.Q(:, 2:3:end);
    limits = [min(x(:)), max(x(:)), min(y(:)), max(y(:))] + 1.1 * reach * [-1 1 -1 1];
end

gif = ~isempty(regexp(options.Output, '\.gif$', 'once'));
folder = options.Output;
if gif
    folder = tempname();
end
if ~isempty(folder) && exist(folder, 'dir') ~= 7
    mkdir(folder);
end
visible = 'on';
if ~isempty(folder)
    visible = 'off';
end
fig = figure('visible', visible);
colours = [0.25 0.45 0.75; 0.85 0.45 0.20; 0.35 0.65 0.35; 0.60 0.40 0.70; 0.75 0.65 0.20];
files = {};
for i = 1:options.Every:numel(r.T)
    cla();
    hold('on');
    for k = 1:numel(walls)
        plot(walls{k}(1, :), walls{k}(2, :), 'k', 'linewidth', 2);
    end
    for k = 1:n
        q = r.Q(i, 3 * k - 2:3 * k);
        p = [cos(q(3)), -sin(q(3)); sin(q(3)), cos(q(3))] * shapes{k};
        patch(p(1, :) + q(1), p(2, :) + q(2), colours(1 + mod(sim.links(k).body - 1, 5), :));
    end
    hold('off');
    axis('equal');
    axis(limits);
    box('on');
    title(sprintf('t = %.2f', r.T(i)));
    if isempty(folder)
        drawnow();
    else
        files{end + 1} = fullfile(folder, sprintf('frame_%04d.png', numel(files) + 1)); %#ok<AGROW>
        nekton_print(fig, files{end});
    end
end
delete(sim);
if ~isempty(folder)
    close(fig);
end
if gif
    join(files, options.Output, min(0.2, r.T(2) * options.Every));
    files = {options.Output};
end
end

function join(files, output, delay)
% PNG files into one animated GIF.
options = {};
if exist('OCTAVE_VERSION', 'builtin')
    options = {'Compression', 'lzw'}; % Matlab always does so
end
for k = 1:numel(files)
    picture = imread(files{k});
    if size(picture, 3) == 1
        picture = repmat(picture, [1 1 3]);
    end
    % 6 x 6 x 6 colours are enough for this.
    levels = round(double(picture(:, :, 1:3)) / 255 * 5);
    index = uint8(levels(:, :, 1) * 36 + levels(:, :, 2) * 6 + levels(:, :, 3));
    [blue, green, red] = ndgrid(0:5, 0:5, 0:5);
    map = [red(:), green(:), blue(:)] / 5;
    if k == 1
        imwrite(index, map, output, 'gif', 'DelayTime', delay, 'LoopCount', Inf, options{:});
    else
        imwrite(index, map, output, 'gif', 'WriteMode', 'append', 'DelayTime', delay, options{:});
    end
    delete(files{k});
end
rmdir(fileparts(files{1}));
end
