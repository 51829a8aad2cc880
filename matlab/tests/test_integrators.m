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
end
end
