function test_integrators
% Every method goes where the variable-step method goes; a limit of steps ends a call with an error of its own.
exact = Nekton(eggs(), 'tolerance', 1e-11);
exact.advance(0.5);
for method = {'rk4', 'abm4', 'gauss6'}
    sim = Nekton(eggs(), 'method', method{1}, 'step', 0.02);
    sim.advance(0.5);
    near(sim.positions, exact.positions, 1e-6);
    sim.setStepLimit(3);
    raises('nekton:sim:TooManySteps', @() sim.advance(1.0));
    near(sim.time, 0.5, 0);
    raises('nekton:arg:range', @() sim.setStepLimit(0));
    for option = {'MaxStep', 'InitialStep'}
        raises('nekton:scene:OutOfRange', @() Nekton(eggs(), 'method', method{1}, 'step', 0.02, option{1}, 0.1));
    end
end

% The longest and the first step of adams.
sim = Nekton(eggs(), 'MaxStep', 0.01, 'InitialStep', 1e-6);
sim.step();
near(sim.time, 1e-6, 1e-20);
sim.advance(0.5);
near(sim.positions, exact.positions, 1e-6);
assert(sim.counters().steps >= 51);
for option = {'MaxStep', 'InitialStep'}
    raises('nekton:arg:range', @() Nekton(eggs(), option{1}, 0));
    raises('nekton:arg:class', @() Nekton(eggs(), option{1}, 'long'));
    raises('nekton:scene:BadStep', @() Nekton(eggs(), option{1}, -1));
end

% Estimated errors of time: no smaller than the true ones, and at most a thousand times as large.
for method = {'rk4', 'abm4', 'gauss6'}
    sim = Nekton(eggs(), 'method', method{1}, 'step', 0.02);
    sim.advance(0.5);
    e = sim.timeError();
    if strcmp(method{1}, 'gauss6')
        assert(isnan(e.length) && e.unknown == 25 && isnan(e.length_sum));
        continue
    end
    d = abs(sim.positions - exact.positions);
    told = [e.length_sum + 0.5 * e.speed_sum, e.angle_sum + 0.5 * e.spin_sum];
    true_error = [max(max(d(1:2, :))), max(d(3, :))];
    assert(all(told > true_error) && all(told < 1000 * true_error + 1e-11));
    assert(e.length > 0 && e.angle > 0 && e.speed > 0 && e.spin > 0 && e.unknown > 0);
end
end
