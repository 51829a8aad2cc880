function test_examples()
% The search for a cheap stroke keeps the displacement asked for, does not make things worse, and draws what it found.
here = fileparts(fileparts(mfilename('fullpath')));
addpath(fullfile(here, 'examples'));
file = [tempname() '.png'];
text = evalc('[best, history] = optimal_stroke(file, 6);');
near(best.moved, 0.25, 1e-6);
assert(best.cost <= history(1) && numel(history) >= 6);
assert(~isempty(strfind(text, 'cost')) && ~isempty(strfind(text, 'before')));
picture = imread(file);
delete(file);
assert(numel(unique(picture(:))) > 2);
end
