/*
 * The swimmer of swimmer_prescribed.c in C++17: two hinges follow -cos t and sin t.
 *
 * Compile:
 *   c++ -std=c++17 swimmer.cpp -I ../target/nekton/include ../target/nekton/lib/libnekton.a -lm -o swimmer
 */
#include "nekton.hpp"
#include <array>
#include <cstdio>
#include <vector>

int main()
{
    const double pi = 3.14159265358979323846;
    /* amplitude, frequency, phase, offset */
    const nekton::Harmonic front[] = {{-1.0, 1.0, pi / 2.0, 0.0}}, rear[] = {{1.0, 1.0, 0.0, 0.0}};
    nekton::Link links[3];
    for (nekton::Link &link : links) {
        link = nekton::Link::ellipse(1.0, 0.1); // of density 1, like the fluid
        link.nodes = 64; // without it as many as an error of 1e-6 takes
    }
    links[1].hinge(0, {-1.2, 0.0}, {1.2, 0.0}).moved_by(front);
    links[2].hinge(0, {1.2, 0.0}, {-1.2, 0.0}).moved_by(rear);
    nekton::Body body(links);
    const std::array<double, 3> velocity = {-0.43406482698683885, -0.22678503735025515, -0.3446110319592447};
    for (std::size_t i = 0; i < 3; i++) {
        body.velocity[i] = velocity[i]; // with which the impulse of the whole is zero
    }

#ifndef NEKTON_NO_EXCEPTIONS
    try {
        links[2].nodes = 47;
        nekton::Model refused{nekton::Scene(body)};
        return 1;
    } catch (const nekton::Error &error) {
        std::fprintf(stderr, "as it should be: %s\n", error.what());
        links[2].nodes = 64;
    }
#endif

    nekton::Model model{nekton::Scene(body)};
    nekton::Sim sim(model, nekton::Method::adams(1e-8));
    if (!sim) {
        return 1; // only without exceptions
    }
    std::vector<double> q(model.plan().coordinates), torque(model.plan().joints), power(model.plan().joints);
    for (int i = 1; i <= 8; i++) {
        sim.advance(i * pi / 4.0);
        sim.joint_torques(torque, power);
        sim.positions(q);
        std::printf("%.17g %.17g %.17g %.17g %.17g %.17g\n", sim.time(), q[0], q[1], q[2], torque[0], torque[1]);
    }
    return 0;
}
