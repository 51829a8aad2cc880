function [T, E_tot, E_fl, E_fi, E_pot, E_def, E_net, torques, power] = bht_energy(varargin)
%BHT_ENERGY  Energies, torques and power of a computed motion.
%   [T, E_tot, E_fl, E_fi, E_pot, E_def, E_net, torques, power] = BHT_ENERGY('DataFilename', name) reads name_results, which
%   bht_traject_compute wrote. Columns, one row per time step:
%
%     T         times
%     E_tot     kinetic energy of fluid and bodies, E_fl + E_fi
%     E_fl      of the fluid
%     E_fi      of the bodies, E_net + E_def
%     E_pot     potential energy of weight and buoyancy; [] when it never differs from 0
%     E_def     of the bodies' deformation: their links' motion as seen from a frame that moves with the body's centre of mass and
%               turns so that the angular momentum in it is 0 (our choice of frame; with it the sum is exact)
%     E_net     of the bodies' motion as if rigid
%     torques   of the hinges, one column per control
%     power     torques times the rates of the angles
%
%   Conserved for free bodies: E_tot + E_pot (+ repulsion, in the results as E_rep); with moving hinges its rate is the sum of power.

options = bht_options(struct('DataFilename', ''), varargin{:});
r = bht_results(options.DataFilename);
T = r.T;
E_fl = r.E_fl;
E_pot = r.E_pot;
if ~any(E_pot)
    E_pot = [];
end
torques = r.torques;
power = r.power;

n = numel(T);
E_net = zeros(n, 1);
E_def = zeros(n, 1);
bodies = [r.links.body];
for b = unique(bodies)
    k = find(bodies == b);
    m = [r.links(k).mass];
    inertia = [r.links(k).inertia];
    x = r.Q(:, 3 * k - 2);
    y = r.Q(:, 3 * k - 1);
    vx = r.V(:, 3 * k - 2);
    vy = r.V(:, 3 * k - 1);
    omega = r.V(:, 3 * k);
    total = sum(m);
    if total == 0
        E_def = E_def + 0.5 * (omega.^2 * inertia');
        continue
    end
    one = ones(1, numel(k));
    rx = x - (x * m' / total) * one;
    ry = y - (y * m' / total) * one;
    gx = vx * m' / total;
    gy = vy * m' / total;
    I = (rx.^2 + ry.^2) * m' + sum(inertia);
    L = (rx .* vy - ry .* vx) * m' + omega * inertia';
    turn = L ./ I;
    E_net = E_net + 0.5 * total * (gx.^2 + gy.^2) + 0.5 * L .* turn;
    ux = vx - gx * one + ry .* (turn * one);
    uy = vy - gy * one - rx .* (turn * one);
    E_def = E_def + 0.5 * ((ux.^2 + uy.^2) * m') + 0.5 * ((omega - turn * one).^2 * inertia');
end
E_fi = E_net + E_def;
E_tot = E_fl + E_fi;
end
