function y = bht_round_rectangle(t, der, settings)
%BHT_ROUND_RECTANGLE  Boundary: rectangle with rounded corners.
%   y = BHT_ROUND_RECTANGLE(t, der, [x1 x2 w h r s]): points (der = 0), first or second derivative (der = 1, 2) at parameters t,
%   2 x n. Centre (x1, x2), w along x, h along y, corners of radius r, s = 1 counter-clockwise, -1 clockwise.
%   (The settings of the old toolbox's function of this name are not public; these are our choice.)
%
%   All derivatives exist: the outline is the rectangle, averaged along its length with a logistic weight of width r / 2.62,
%   which has the added mass of corners that are arcs of radius r.

t = t(:)';
w = settings(3);
h = settings(4);
width = settings(5) / 2.62;
s = settings(6);
perimeter = 2 * (w + h);
corners = [w w -w -w; -h h h -h] / 2;
directions = [0 -1 0 1; 1 0 -1 0]; % of the sides that begin at the corners
turns = directions - directions(:, [4 1 2 3]);
at = [0 h, h + w, 2 * h + w];
sigma = mod(s * t / (2 * pi), 1) * perimeter;
side = sum(bsxfun(@ge, sigma, at'), 1);
unit = directions(:, side);
y = zeros(2, numel(t));
if der == 0
    y = corners(:, side) + unit .* repmat(sigma - at(side), 2, 1);
elseif der == 1
    y = unit;
end
for m = 1:4
    for image = -1:1
        d = (sigma - at(m) - image * perimeter) / width;
        e = exp(-abs(d));
        switch der
            case 0
                y = y + turns(:, m) * (width * log1p(e));
            case 1
                y = y - turns(:, m) * (signs(d) .* e ./ (1 + e));
            case 2
                y = y + turns(:, m) * (e ./ (1 + e).^2 / width);
            otherwise
                error('nekton:bht:der', 'der must be 0, 1 or 2');
        end
    end
end
rate = s * perimeter / (2 * pi);
if der == 0
    y = y + repmat([settings(1); settings(2)], 1, numel(t));
else
    y = y * rate^der;
end
end

function s = signs(d)
% At a corner itself, its side is the one that begins there.
s = 2 * (d >= 0) - 1;
end
