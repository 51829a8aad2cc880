function dy = reference_rhs(t, y, scene)
%REFERENCE_RHS  Rate of y = [p; dp/dt] by the algorithm of Munnier and Pincon (2010), in plain matrix code.
%   scene: density (fluid), n (nodes per link), links (struct array: a, b, density, body, parent, father_anchor, own_anchor; the
%   first link of a body has parent 0) and controls, [c, dc, ddc] = f(t) for the other links in their order.
%   p holds x, y, theta of the first link of each body.
%
%   Equation numbers are the paper's: potentials (8.2) with the logarithmic right-hand side (8.6), (8.7), one LU factorization for all
%   of them; added mass (2.11); Christoffel force by the boundary formula (2.15); articulated bodies (6.3).

links = scene.links;
count = numel(links);
n = scene.n;
free = numel(y) / 2;
p = y(1:free);
dp = y(free + 1:end);
[c, dc, ddc] = scene.controls(t);

% Kinematics: q = F(p, u), its Jacobian J over (p, u), and the part A of d2q/dt2 that is quadratic in the rates.
q = zeros(3, count);
dq = zeros(3, count);
A = zeros(3, count);
J = zeros(3 * count, free + numel(c));
joint = 0;
mass = zeros(3 * count, 1);
for i = 1:count
    own = 3 * i - 2:3 * i;
    l = links(i);
    if l.parent == 0
        at = 3 * l.body - 2:3 * l.body;
        q(:, i) = p(at);
        dq(:, i) = dp(at);
        J(own, at) = eye(3);
    else
        joint = joint + 1;
        f = l.parent;
        theirs = 3 * f - 2:3 * f;
        q(3, i) = q(3, f) + c(joint);
        dq(3, i) = dq(3, f) + dc(joint);
        h = turn(q(3, f)) * l.father_anchor(:);
        g = turn(q(3, i)) * l.own_anchor(:);
        q(1:2, i) = q(1:2, f) + h - g;
        J(own, :) = J(theirs, :);
        J(own(3), free + joint) = 1;
        J(own(1:2), :) = J(own(1:2), :) + [-h(2); h(1)] * J(theirs(3), :) - [-g(2); g(1)] * J(own(3), :);
        dq(1:2, i) = dq(1:2, f) + [-h(2); h(1)] * dq(3, f) - [-g(2); g(1)] * dq(3, i);
        A(1:2, i) = A(1:2, f) - h * dq(3, f)^2 + g * dq(3, i)^2;
    end
    m = l.density * pi * l.a * l.b;
    mass(own) = [m; m; m * (l.a^2 + l.b^2) / 4];
end

% Boundaries: points x, normal into the solid times arc length per parameter, curvature, normal velocities b of the 3 motions.
s = (0:n - 1)' * 2 * pi / n;
w = 2 * pi / n;
total = n * count;
x = zeros(total, 2);
normal = zeros(total, 2);
speed = zeros(total, 1);
curvature = zeros(total, 1);
arm = zeros(total, 2);
for i = 1:count
    k = (i - 1) * n + (1:n);
    l = links(i);
    R = turn(q(3, i))';
    tangent = [-l.a * sin(s), l.b * cos(s)] * R;
    arm(k, :) = [l.a * cos(s), l.b * sin(s)] * R;
    x(k, :) = arm(k, :) + ones(n, 1) * q(1:2, i)';
    speed(k) = sqrt(sum(tangent.^2, 2));
    normal(k, :) = [-tangent(:, 2), tangent(:, 1)] ./ (speed(k) * [1 1]);
    curvature(k) = l.a * l.b ./ speed(k).^3;
end
moment = arm(:, 1) .* normal(:, 2) - arm(:, 2) .* normal(:, 1);
b = zeros(total, 3 * count);
for i = 1:count
    k = (i - 1) * n + (1:n);
    b(k, 3 * i - 2:3 * i) = [normal(k, :), moment(k)];
end

% Potentials, (8.2).
dx = ones(total, 1) * x(:, 1)' - x(:, 1) * ones(1, total);
dy2 = ones(total, 1) * x(:, 2)' - x(:, 2) * ones(1, total);
square = dx.^2 + dy2.^2;
square(1:total + 1:end) = 1;
kernel = (dx .* (ones(total, 1) * normal(:, 1)') + dy2 .* (ones(total, 1) * normal(:, 2)')) ./ square;
kernel(1:total + 1:end) = -curvature / 2;
ds = w * speed;
system = eye(total) - kernel .* (ones(total, 1) * ds') / pi;
logarithm = 0.5 * log(square) * w;
order = (1:n / 2 - 1)';
weights = -w * (cos(s * order') * (1 ./ order)) - pi / (n / 2 * n) * cos(n / 2 * s);
difference = mod((0:n - 1)' * ones(1, n) - ones(n, 1) * (0:n - 1), n);
sine = 2 * abs(sin(difference * pi / n));
sine(1:n + 1:end) = 1;
for i = 1:count
    k = (i - 1) * n + (1:n);
    smooth = 0.5 * log(square(k, k)) - log(sine);
    smooth(1:n + 1:end) = log(speed(k));
    logarithm(k, k) = smooth * w + weights(difference + 1);
end
psi = system \ (-logarithm * (b .* (speed * ones(1, 3 * count))) / pi);

% Added mass (2.11) and Christoffel force (2.15).
added = psi' * (b .* (ds * ones(1, 3 * count)));
M = diag(mass) + scene.density / 2 * (added + added');
slope = zeros(total, 3 * count);
wave = 1i * [0:n / 2 - 1, 0, -n / 2 + 1:-1]';
for i = 1:count
    k = (i - 1) * n + (1:n);
    slope(k, :) = -real(ifft(fft(psi(k, :)) .* (wave * ones(1, 3 * count)))) ./ (speed(k) * ones(1, 3 * count));
end
v = dq(:);
flow = slope * v;
vn = b * v;
rate = zeros(total, 1);
spin = zeros(total, 1);
for i = 1:count
    k = (i - 1) * n + (1:n);
    toward = sum(arm(k, :) .* normal(k, :), 2);
    rate(k) = -normal(k, 2) * dq(1, i) + normal(k, 1) * dq(2, i) + toward * dq(3, i);
    spin(k) = 2 * rate(k) * dq(3, i) - toward * dq(3, i)^2;
end
source = curvature .* (rate.^2 - vn.^2) + spin;
force = scene.density * (-slope' * (flow .* vn .* ds) + 0.5 * b' * ((flow.^2 + vn.^2) .* ds) + psi' * (source .* ds));

% Articulated bodies (6.3).
P = J(:, 1:free);
known = A(:);
if ~isempty(c)
    known = known + J(:, free + 1:end) * ddc(:);
end
dy = [dp; -(P' * M * P) \ (P' * (M * known + force))];
end

function R = turn(angle)
R = [cos(angle), -sin(angle); sin(angle), cos(angle)];
end
