function test_figures()
% Figures, frames and movies are written and are not empty.
here = fileparts(fileparts(mfilename('fullpath')));
warning('off', 'Octave:gnuplot-graphics');
folder = tempname();
mkdir(folder);
back = cd(folder);
figure('visible', 'off');
sim = Nekton(eggs(), 'tolerance', 1e-6);
sim.animate([0 1], 'limits', [-4 6 -4 6], 'frames', 'frames');
written(fullfile('frames', 'frame_0001.png'), 1000);
written(fullfile('frames', 'frame_0002.png'), 1000);
bht_traject_compute('DataFilename', fullfile(here, 'examples', 'two_eggs.dat'), 'Tolerance', 1e-6);
bht_simulation('DataFilename', 'two_eggs', 'Output', 'eggs.gif', 'Every', 50);
written('eggs.gif', 1000);
about = imfinfo('eggs.gif');
assert(numel(about) == 3 && isequal([about.Width], about(1).Width * [1 1 1]), 'frames of different size');
files = bht_simulation('DataFilename', 'two_eggs', 'Output', 'movie', 'Every', 100);
near(numel(files), 2, 0);
written(files{2}, 1000);
cd(back);
confirm_recursive_rmdir(false, 'local');
rmdir(folder, 's');
end

function written(name, least)
file = dir(name);
assert(numel(file) == 1 && file.bytes > least, '%s was not written', name);
picture = imread(name);
assert(numel(unique(picture(:))) > 2, '%s is empty', name);
end
