function [c, dc, dttc] = fish_controls(t, cont_parameters)
% A wave that runs down the three hinges on [0, 6 pi]; cont_parameters: the three amplitudes.
a = cont_parameters(:);
phase = [0; -1.2; -2.4];
[w, dw, ddw] = bht_step2(t, 2 * pi, 6 * pi);
s = a .* sin(t + phase);
ds = a .* cos(t + phase);
c = w * s;
dc = dw * s + w * ds;
dttc = ddw * s + 2 * dw * ds - w * s;
end
