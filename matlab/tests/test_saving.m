function test_saving()
% A simulation goes on from its bytes to the bit; bytes that are not its own are refused, and nothing changes.
scene = swimmer(struct('harmonic', struct('amplitude', 0.4, 'frequency', 2)));
for method = {'adams', 'rk4', 'abm4', 'gauss6'}
    sim = Nekton(scene, 'method', method{1}, 'step', 0.02);
    sim.advance(0.31);
    bytes = sim.toBytes();
    assert(isa(bytes, 'uint8') && isrow(bytes) && numel(bytes) > 500);
    % The other one has another method and a past.
    other = Nekton(scene, 'method', 'rk4', 'step', 0.05);
    other.advance(0.1);
    other.fromBytes(bytes);
    for k = 1:2
        assert(isequal(sim.positions(), other.positions()) && isequal(sim.counters(), other.counters()));
        assert(isequaln(sim.timeError(), other.timeError()) && isequal(sim.toBytes(), other.toBytes()));
        sim.advance(0.77);
        other.advance(0.77);
    end
end

before = sim.toBytes();
for k = [1 9 60 numel(bytes)]
    damaged = bytes;
    damaged(k) = bitxor(damaged(k), 4);
    raises('nekton:sim:BadSave', @() sim.fromBytes(damaged));
end
raises('nekton:sim:BadSave', @() sim.fromBytes(bytes(1:end - 1)));
raises('nekton:sim:BadSave', @() sim.fromBytes(uint8([])));
raises('nekton:arg:class', @() sim.fromBytes(double(bytes)));
assert(isequal(before, sim.toBytes()));
scene.fluid = struct('density', 1.01);
heavier = Nekton(scene);
raises('nekton:sim:BadSave', @() heavier.fromBytes(bytes));

% Controls: at the end of a control step.
start = @() Nekton(swimmer(), 'controls', @sway, 'control_step', 0.1);
sim = start();
raises('nekton:sim:Unsupported', @() sim.toBytes());
sim.advance(0.55);
raises('nekton:sim:Unsupported', @() sim.toBytes());
sim.step();
sim.advance(0.7);
other = start();
other.fromBytes(sim.toBytes());
for k = 1:2
    assert(isequal(sim.positions(), other.positions()) && isequal(sim.velocities(), other.velocities()));
    sim.advance(1.23);
    other.advance(1.23);
end
end

function [c, dc, ddc] = sway(t)
c = 0.1 * sin(t)^3;
dc = 0.3 * sin(t)^2 * cos(t);
ddc = 0.6 * sin(t) * cos(t)^2 - 0.3 * sin(t)^3;
end
