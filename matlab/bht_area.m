function [area, centroid] = bht_area(y, dy)
%BHT_AREA  Signed area (positive: counter-clockwise) and centroid of a closed curve.
%   [area, centroid] = BHT_AREA(y, dy): points and derivatives at n equal steps of t over [0, 2 pi), both 2 x n.
h = 2 * pi / size(y, 2);
area = h / 2 * sum(y(1, :) .* dy(2, :) - y(2, :) .* dy(1, :));
centroid = h / 2 * [sum(y(1, :).^2 .* dy(2, :)); -sum(y(2, :).^2 .* dy(1, :))] / area;
end
