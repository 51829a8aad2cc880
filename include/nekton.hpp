/**
 * nekton.hpp: a thin C++17 layer over nekton.h and nekton32.h. Models and simulations free themselves, buffers know their
 * length, and errors are exceptions. Its parts are in nekton/.
 *
 *   nekton::Link link = nekton::Link::ellipse(1.0, 0.4);
 *   nekton::Body body(link);
 *   nekton::Scene scene(body);
 *   nekton::Model model(scene);
 *   nekton::Sim sim(model, nekton::Method::adams(1e-8));
 *   sim.advance(1.0);
 *
 * Model32, Sim32 and so on are the same in single precision.
 *
 * Errors: every function that can fail throws nekton::Error. With NEKTON_NO_EXCEPTIONS defined, or exceptions switched off in
 * the compiler, nothing is thrown: functions return their nekton_status, a constructor that failed leaves an empty object
 * (false in a condition), and the last argument, a nekton_diag *, tells why. It may be given in either case.
 *
 * Lifetime: a model must outlive its simulations; both may be moved meanwhile. Definitions (Scene, Body, Link) only point to
 * their parts, as in C, and are not needed once the model is made.
 *
 * Threads: as in C. A model may be used by any number of threads at once, a simulation by one at a time.
 */
#ifndef NEKTON_HPP
#define NEKTON_HPP

#include "nekton/definitions.hpp"
#include "nekton/model.hpp"
#include "nekton/sim.hpp"

namespace nekton {

using Method = BasicMethod<double>;
using Link = BasicLink<double>;
using Wall = BasicWall<double>;
using Body = BasicBody<double>;
using Scene = BasicScene<double>;
using Model = BasicModel<double>;
using Sim = BasicSim<double>;
using Harmonic = nekton_harmonic;

using Method32 = BasicMethod<float>;
using Link32 = BasicLink<float>;
using Wall32 = BasicWall<float>;
using Body32 = BasicBody<float>;
using Scene32 = BasicScene<float>;
using Model32 = BasicModel<float>;
using Sim32 = BasicSim<float>;
using Harmonic32 = nekton32_harmonic;

} // namespace nekton

#endif /* NEKTON_HPP */
