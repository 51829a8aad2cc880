function test_two_eggs()
% Two eggs reach the reference positions at t = 10, and conserve energy and impulse.
sim = Nekton(eggs(), 'tolerance', 1e-11);
before = sim.energy();
impulse = sim.impulse();
sim.advance(10);
q = sim.positions();
near(q, [7.2064755992337, -1.1070979855674, -1.2591097272845, -2.8584118752586, 7.6710947047387, 0.8190183042321], 1e-9);
after = sim.energy();
near(after.total, before.total, 1e-9);
near(sim.impulse(), impulse, 1e-9);
assert(sim.time() == 10);
end
