function test_checkers()
% The boundary and controls checkers pass what is right and find planted errors.
figure('visible', 'off');
text = evalc('good = bht_boundary_check(''bht_ellipse'', [1 2 3 1 1], 1e-8);');
assert(good && isempty(text), text);
assert(bht_boundary_check(@bht_ellipse, [0 0 1 0.02 1]));
assert(bht_boundary_check('bht_round_rectangle', [1 2 3 1 0.1 1], 1e-8));
text = evalc('good = bht_boundary_check(''bht_round_rectangle'', [1 2 3 1 0.1 -1]);');
assert(good && ~isempty(strfind(text, 'clockwise')));
wrong = @(t, der, s) bht_ellipse(t, der, s) + 1e-4 * (der == 1) * [sin(t); cos(t)];
text = evalc('good = bht_boundary_check(wrong, [0 0 2 1 1]);');
assert(~good && ~isempty(strfind(text, 'derivative 1')));
wrong = @(t, der, s) bht_ellipse(t, der, s) * (1 + 1e-4 * (der == 2));
text = evalc('good = bht_boundary_check(wrong, [0 0 2 1 1]);');
assert(~good && ~isempty(strfind(text, 'derivative 2')) && isempty(strfind(text, 'derivative 1')));
wrong = @(t, der, s) bht_ellipse(t, der, s) + 0.01 * [t .* (der == 0) + (der == 1); 0 * t];
text = evalc('good = bht_boundary_check(wrong, [0 0 2 1 1]);');
assert(~good && ~isempty(strfind(text, 'not closed')));
raises('nekton:bht:boundary', @() bht_boundary_check(@(t, der, s) t(:), 0));

text = evalc('good = bht_controls_check(@right, 10, [1; 2]);');
assert(good && isempty(text), text);
text = evalc('good = bht_controls_check(@(t, p) deal(sin(t), cos(t), -sin(t)));');
assert(good && ~isempty(strfind(text, 'drift')));
text = evalc('good = bht_controls_check(@wrong_rate, 10, [1; 2]);');
assert(~good && ~isempty(strfind(text, 'control 2: dc is wrong')) && isempty(strfind(text, 'control 1')));
text = evalc('good = bht_controls_check(@wrong_acceleration, 10, [1; 2]);');
assert(~good && ~isempty(strfind(text, 'control 1: dttc is wrong')) && isempty(strfind(text, 'control 2')));
raises('nekton:bht:controls', @() bht_controls_check(@(t, p) deal([1 2], 1, 1)));

% The steps' derivatives.
for k = {@(t, p) outputs(@() bht_step1(t, 0.7)), @(t, p) outputs(@() bht_step2(t, 2, 7))}
    f = k{1};
    assert(bht_controls_check(@(t, p) three(f, t), 8));
end
near(bht_step1([-1 0 0.35 0.7 2], 0.7), [0 0 0.5 1 1], 1e-15);
near(bht_step2([0 2 3 5 7], 2, 7), [0 1 1 1 0], 1e-15);
end

function [c, dc, ddc] = right(t, p)
[w, dw, ddw] = bht_step2(t, 3, 8);
c = p * w;
dc = p * dw;
ddc = p * ddw;
end

function [c, dc, ddc] = wrong_rate(t, p)
[c, dc, ddc] = right(t, p);
dc(2) = dc(2) * 1.0001;
ddc(2) = ddc(2) * 1.0001;
end

function [c, dc, ddc] = wrong_acceleration(t, p)
[c, dc, ddc] = right(t, p);
ddc(1) = ddc(1) + 1e-4 * sin(t);
end

function x = outputs(f)
[x1, x2, x3] = f();
x = [x1, x2, x3];
end

function [c, dc, ddc] = three(f, t)
x = f(t, []);
c = x(1);
dc = x(2);
ddc = x(3);
end
