function y = bht_ellipse(t, der, settings)
%BHT_ELLIPSE  Boundary: ellipse.
%   y = BHT_ELLIPSE(t, der, [x1 x2 a b s]): points (der = 0), first or second derivative (der = 1, 2) at parameters t, 2 x n.
%   Centre (x1, x2), semi-axes a along x and b along y; s = 1 counter-clockwise, -1 clockwise.

t = t(:)';
a = settings(3);
b = settings(4) * settings(5);
switch der
    case 0
        y = [settings(1) + a * cos(t); settings(2) + b * sin(t)];
    case 1
        y = [-a * sin(t); b * cos(t)];
    case 2
        y = [-a * cos(t); -b * sin(t)];
    otherwise
        error('nekton:bht:der', 'der must be 0, 1 or 2');
end
end
