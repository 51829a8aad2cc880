/**
 * nekton.hpp: a thin C++17 layer over nekton.h. Models and simulations free themselves, buffers know their length, and errors
 * are exceptions.
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

#include "nekton.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

#if !defined(NEKTON_NO_EXCEPTIONS) && !defined(__cpp_exceptions)
#define NEKTON_NO_EXCEPTIONS
#endif
#ifndef NEKTON_NO_EXCEPTIONS
#include <exception>
#endif

namespace nekton {

/** A pointer and a length. Made of anything that has data() and size(), and of arrays. */
template <class T> class Span {
public:
    constexpr Span(T *data, std::size_t size) noexcept : data_(data), size_(size) {}
    template <std::size_t N> constexpr Span(T (&array)[N]) noexcept : data_(array), size_(N) {}
    template <class C, class = std::enable_if_t<std::is_convertible_v<decltype(std::declval<C &>().data()), T *>>>
    constexpr Span(C &&container) noexcept : data_(container.data()), size_(container.size())
    {
    }
    constexpr T *data() const noexcept { return data_; }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr T *begin() const noexcept { return data_; }
    constexpr T *end() const noexcept { return data_ + size_; }
    constexpr T &operator[](std::size_t i) const noexcept { return data_[i]; }

private:
    T *data_;
    std::size_t size_;
};

#ifndef NEKTON_NO_EXCEPTIONS
/** What went wrong: what() is the whole text, diag() the parts. */
class Error : public std::exception {
public:
    explicit Error(const nekton_diag &diag) noexcept : diag_(diag) { nekton_diag_text(&diag_, text_, sizeof text_); }
    const char *what() const noexcept override { return text_; }
    const nekton_diag &diag() const noexcept { return diag_; }
    nekton_status status() const noexcept { return diag_.status; }

private:
    nekton_diag diag_;
    char text_[160] = {};
};
#endif

/** What is below this line up to Scene chooses between the two precisions. */
namespace detail {

template <class R> struct Api;

#define NEKTON_P_API(R, P)                                                                                                     \
    template <> struct Api<R> {                                                                                                \
        using Shape = P##_shape;                                                                                               \
        using Signal = P##_signal;                                                                                             \
        using Harmonic = P##_harmonic;                                                                                         \
        using Wall = P##_wall_def;                                                                                             \
        using Link = P##_link_def;                                                                                             \
        using Body = P##_body_def;                                                                                             \
        using Scene = P##_scene_def;                                                                                           \
        using Method = P##_method;                                                                                             \
        using Model = P##_model;                                                                                               \
        using Sim = P##_sim;                                                                                                   \
        using LinkInfo = P##_link_info;                                                                                        \
        using Energy = P##_energy;                                                                                             \
        using Resolution = P##_resolution;                                                                                     \
        using TimeError = P##_time_error;                                                                                      \
        using Gap = P##_gap;                                                                                                   \
        static constexpr auto scene_init = &P##_scene_def_init;                                                                \
        static constexpr auto wall_init = &P##_wall_def_init;                                                                  \
        static constexpr auto body_init = &P##_body_def_init;                                                                  \
        static constexpr auto link_init = &P##_link_def_init;                                                                  \
        static constexpr auto model_req = &P##_model_req;                                                                      \
        static constexpr auto model_init = &P##_model_init;                                                                    \
        static constexpr auto model_create = &P##_model_create;                                                                \
        static constexpr auto model_free = &P##_model_free;                                                                    \
        static constexpr auto model_plan = &P##_model_plan;                                                                    \
        static constexpr auto model_link = &P##_model_link;                                                                    \
        static constexpr auto model_joint = &P##_model_joint;                                                                  \
        static constexpr auto model_notice = &P##_model_notice;                                                                \
        static constexpr auto model_nodes = &P##_model_nodes;                                                                  \
        static constexpr auto model_outline_point = &P##_model_outline_point;                                                  \
        static constexpr auto sim_req = &P##_sim_req;                                                                          \
        static constexpr auto sim_init = &P##_sim_init;                                                                        \
        static constexpr auto sim_create = &P##_sim_create;                                                                    \
        static constexpr auto sim_free = &P##_sim_free;                                                                        \
        static constexpr auto sim_copy = &P##_sim_copy;                                                                        \
        static constexpr auto sim_model = &P##_sim_model;                                                                      \
        static constexpr auto sim_time = &P##_sim_time;                                                                        \
        static constexpr auto sim_positions = &P##_sim_positions;                                                              \
        static constexpr auto sim_velocities = &P##_sim_velocities;                                                            \
        static constexpr auto sim_get_state = &P##_sim_get_state;                                                              \
        static constexpr auto sim_set_state = &P##_sim_set_state;                                                              \
        static constexpr auto sim_restart = &P##_sim_restart;                                                                  \
        static constexpr auto sim_step = &P##_sim_step;                                                                        \
        static constexpr auto sim_advance = &P##_sim_advance;                                                                  \
        static constexpr auto sim_advance_dense = &P##_sim_advance_dense;                                                      \
        static constexpr auto sim_set_step_limit = &P##_sim_set_step_limit;                                                    \
        static constexpr auto sim_set_channel = &P##_sim_set_channel;                                                          \
        static constexpr auto sim_rhs = &P##_sim_rhs;                                                                          \
        static constexpr auto sim_joint_values = &P##_sim_joint_values;                                                        \
        static constexpr auto sim_joint_torques = &P##_sim_joint_torques;                                                      \
        static constexpr auto sim_accelerations = &P##_sim_accelerations;                                                      \
        static constexpr auto sim_mass_matrix = &P##_sim_mass_matrix;                                                          \
        static constexpr auto sim_added_mass = &P##_sim_added_mass;                                                            \
        static constexpr auto sim_christoffel = &P##_sim_christoffel;                                                          \
        static constexpr auto sim_christoffel_tensor = &P##_sim_christoffel_tensor;                                            \
        static constexpr auto sim_buoyancy = &P##_sim_buoyancy;                                                                \
        static constexpr auto sim_repulsion = &P##_sim_repulsion;                                                              \
        static constexpr auto sim_circulation_gradient = &P##_sim_circulation_gradient;                                        \
        static constexpr auto sim_gyroscopic = &P##_sim_gyroscopic;                                                            \
        static constexpr auto sim_energy = &P##_sim_energy;                                                                    \
        static constexpr auto sim_impulse = &P##_sim_impulse;                                                                  \
        static constexpr auto sim_indicators = &P##_sim_indicators;                                                            \
        static constexpr auto sim_resolution = &P##_sim_resolution;                                                            \
        static constexpr auto sim_time_error = &P##_sim_time_error;                                                            \
        static constexpr auto sim_gap = &P##_sim_gap;                                                                          \
        static constexpr auto sim_counters = &P##_sim_counters;                                                                \
    }
NEKTON_P_API(double, nekton);
NEKTON_P_API(float, nekton32);
#undef NEKTON_P_API

/** A diag for an error that has no place. */
inline nekton_diag plain(nekton_status status) noexcept
{
    const nekton_place nowhere = {NEKTON_PLACE_NONE, -1, -1};
    nekton_diag diag = {};
    diag.status = status;
    diag.place = diag.other = nowhere;
    diag.item = -1;
    diag.value = diag.time = std::numeric_limits<double>::quiet_NaN();
    return diag;
}

/** Throws if a call failed. */
inline nekton_status done(nekton_status status, const nekton_diag &diag)
{
#ifndef NEKTON_NO_EXCEPTIONS
    if (status < 0) {
        throw Error(diag);
    }
#else
    static_cast<void>(diag);
#endif
    return status;
}

/** The same for calls without a diag. */
inline nekton_status done(nekton_status status) { return status < 0 ? done(status, plain(status)) : status; }

/** Calls `function(diag)`, the caller's diag being filled as well, if there is one. */
template <class F> nekton_status call(nekton_diag *wanted, F function)
{
    nekton_diag own = plain(NEKTON_OK);
    nekton_diag *diag = wanted != nullptr ? wanted : &own;
    return done(function(diag), *diag);
}

} // namespace detail

/** How a simulation is integrated in time. */
template <class R> struct BasicMethod : detail::Api<R>::Method {
    /** Classical Runge-Kutta of order 4 with a fixed step. */
    static BasicMethod rk4(R step) noexcept { return {{NEKTON_METHOD_RK4, step, 0, 0}}; }
    /** Adams-Bashforth-Moulton of order 4 with a fixed step. */
    static BasicMethod abm4(R step) noexcept { return {{NEKTON_METHOD_ABM4, step, 0, 0}}; }
    /** Implicit Gauss-Legendre of order 6 with a fixed step: the energy does not drift. */
    static BasicMethod gauss6(R step) noexcept { return {{NEKTON_METHOD_GAUSS6, step, 0, 0}}; }
    /** Variable order and step; both tolerances. */
    static BasicMethod adams(R tolerance) noexcept { return {{NEKTON_METHOD_ADAMS, 0, tolerance, tolerance}}; }
};

/** A link definition, filled with defaults; all fields of nekton_link_def. */
template <class R> struct BasicLink : detail::Api<R>::Link {
    BasicLink() { detail::done(detail::Api<R>::link_init(this)); }
    /** An ellipse of semi-axes a along x and b along y. */
    static BasicLink ellipse(R a, R b)
    {
        BasicLink link;
        link.shape.kind = NEKTON_SHAPE_ELLIPSE;
        link.shape.a = a;
        link.shape.b = b;
        return link;
    }
    /** Hangs the link on an earlier one of its body by a hinge; anchors from the centroids, in the links' own frames. */
    BasicLink &hinge(int on, std::array<R, 2> at_parent, std::array<R, 2> at_self) noexcept
    {
        this->parent = on;
        this->joint = NEKTON_JOINT_HINGE;
        for (std::size_t i = 0; i < 2; i++) {
            this->parent_anchor[i] = at_parent[i];
            this->self_anchor[i] = at_self[i];
        }
        return *this;
    }
    /** Prescribes the joint's motion as a sum of harmonic terms, which must stay until the model is made. */
    BasicLink &moved_by(Span<const typename detail::Api<R>::Harmonic> terms) noexcept
    {
        this->drive = NEKTON_DRIVE_MOTION;
        this->signal.kind = NEKTON_SIGNAL_HARMONIC;
        this->signal.harmonics = terms.data();
        this->signal.harmonic_count = terms.size();
        return *this;
    }
    /** Drives the joint by a torque that is set while running (see BasicSim::set_channel). */
    BasicLink &torque_from_channel() noexcept
    {
        this->drive = NEKTON_DRIVE_TORQUE;
        this->signal.kind = NEKTON_SIGNAL_CHANNEL;
        return *this;
    }
};

/** A wall definition (tank or obstacle), filled with defaults; all fields of nekton_wall_def. */
template <class R> struct BasicWall : detail::Api<R>::Wall {
    BasicWall() { detail::done(detail::Api<R>::wall_init(this)); }
};

/** A body definition, filled with defaults; all fields of nekton_body_def. Its links must stay until the model is made. */
template <class R> struct BasicBody : detail::Api<R>::Body {
    BasicBody() { detail::done(detail::Api<R>::body_init(this)); }
    explicit BasicBody(const BasicLink<R> &link) : BasicBody(Span<const BasicLink<R>>(&link, 1)) {}
    explicit BasicBody(BasicLink<R> &&) = delete; // would be gone too soon
    explicit BasicBody(Span<const BasicLink<R>> all) : BasicBody()
    {
        this->links = all.data();
        this->link_count = all.size();
    }
};

/** A scene definition, filled with defaults; all fields of nekton_scene_def. Its bodies must stay until the model is made. */
template <class R> struct BasicScene : detail::Api<R>::Scene {
    BasicScene()
    {
        using Def = typename detail::Api<R>::Scene;
        detail::done(detail::Api<R>::scene_init(this, sizeof(Def), NEKTON_ABI_VERSION));
    }
    explicit BasicScene(const BasicBody<R> &body) : BasicScene(Span<const BasicBody<R>>(&body, 1)) {}
    explicit BasicScene(BasicBody<R> &&) = delete; // would be gone too soon
    explicit BasicScene(Span<const BasicBody<R>> all) : BasicScene()
    {
        this->bodies = all.data();
        this->body_count = all.size();
    }
};

static_assert(sizeof(BasicLink<double>) == sizeof(nekton_link_def) && sizeof(BasicBody<double>) == sizeof(nekton_body_def) &&
                  sizeof(BasicScene<double>) == sizeof(nekton_scene_def) && sizeof(BasicLink<float>) == sizeof(nekton32_link_def),
              "arrays of these are arrays of the definitions of C");

/** A compiled scene. Never changes; any number of threads may use it at once. Moves, but is not copied. */
template <class R> class BasicModel {
    using Api = detail::Api<R>;

public:
    /** No model. */
    BasicModel() noexcept = default;
    /** Compiles a scene into memory from the heap. */
    explicit BasicModel(const typename Api::Scene &scene, nekton_diag *diag = nullptr) : owned_(true)
    {
        detail::call(diag, [&](nekton_diag *d) { return Api::model_create(&scene, &model_, d); });
    }
    /** Compiles a scene into memory of the caller (see req), which must stay as long as the model. */
    BasicModel(void *memory, std::size_t size, const typename Api::Scene &scene, nekton_diag *diag = nullptr)
    {
        detail::call(diag, [&](nekton_diag *d) { return Api::model_init(memory, size, &scene, &model_, d); });
    }
    BasicModel(BasicModel &&other) noexcept
        : model_(std::exchange(other.model_, nullptr)), owned_(std::exchange(other.owned_, false))
    {
    }
    BasicModel &operator=(BasicModel &&other) noexcept
    {
        std::swap(model_, other.model_);
        std::swap(owned_, other.owned_);
        return *this;
    }
    BasicModel(const BasicModel &) = delete;
    BasicModel &operator=(const BasicModel &) = delete;
    ~BasicModel()
    {
        if (owned_) {
            Api::model_free(model_);
        }
    }
    /** Memory that a model of this scene needs. */
    static nekton_status req(const typename Api::Scene &scene, nekton_req &out, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::model_req(&scene, &out, d); });
    }

    /** There is a model. */
    explicit operator bool() const noexcept { return model_ != nullptr; }
    /** The handle, for functions of C. */
    const typename Api::Model *get() const noexcept { return model_; }
    /** What is computed and what that costs; zeros if there is no model. */
    nekton_plan plan() const
    {
        nekton_plan out = {};
        detail::done(Api::model_plan(model_, &out));
        return out;
    }
    /** Facts about a link, counted through all bodies. */
    nekton_status link(std::size_t i, typename Api::LinkInfo &out) const { return detail::done(Api::model_link(model_, i, &out)); }
    /** Facts about a joint. */
    nekton_status joint(std::size_t i, nekton_joint_info &out) const { return detail::done(Api::model_joint(model_, i, &out)); }
    /** What set-up noticed and mended. */
    nekton_status notice(std::size_t i, nekton_place &place, nekton_status &what) const
    {
        return detail::done(Api::model_notice(model_, i, &place, &what));
    }
    /** Nodes on a boundary, given or automatic. */
    nekton_status nodes(const nekton_place &place, std::size_t &out) const
    {
        return detail::done(Api::model_nodes(model_, &place, &out));
    }
    /** Point of an outline at a parameter in [0, 2 pi). */
    nekton_status outline_point(const nekton_place &place, R t, std::array<R, 2> &out) const
    {
        return detail::done(Api::model_outline_point(model_, &place, t, out.data()));
    }

private:
    typename Api::Model *model_ = nullptr;
    bool owned_ = false;
};

/** A simulation of a model. One thread at a time, even to read it. Moves; copies of the state by copy_from. */
template <class R> class BasicSim {
    using Api = detail::Api<R>;

public:
    /** No simulation. */
    BasicSim() noexcept = default;
    /** Starts a simulation in memory from the heap. */
    BasicSim(const BasicModel<R> &model, const typename Api::Method &method, nekton_diag *diag = nullptr) : owned_(true)
    {
        detail::call(diag, [&](nekton_diag *d) { return Api::sim_create(model.get(), &method, &sim_, d); });
    }
    /** Starts a simulation in memory of the caller (see req), which must stay as long as the simulation. */
    BasicSim(void *memory, std::size_t size, const BasicModel<R> &model, const typename Api::Method &method,
             nekton_diag *diag = nullptr)
    {
        detail::call(diag, [&](nekton_diag *d) { return Api::sim_init(memory, size, model.get(), &method, &sim_, d); });
    }
    BasicSim(BasicSim &&other) noexcept
        : sim_(std::exchange(other.sim_, nullptr)), owned_(std::exchange(other.owned_, false))
    {
    }
    BasicSim &operator=(BasicSim &&other) noexcept
    {
        std::swap(sim_, other.sim_);
        std::swap(owned_, other.owned_);
        return *this;
    }
    BasicSim(const BasicSim &) = delete;
    BasicSim &operator=(const BasicSim &) = delete;
    ~BasicSim()
    {
        if (owned_) {
            Api::sim_free(sim_);
        }
    }
    /** Memory that a simulation needs. */
    static nekton_status req(const BasicModel<R> &model, const typename Api::Method &method, nekton_req &out,
                             nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_req(model.get(), &method, &out, d); });
    }

    /** There is a simulation. */
    explicit operator bool() const noexcept { return sim_ != nullptr; }
    /** The handle, for functions of C. */
    typename Api::Sim *get() noexcept { return sim_; }
    const typename Api::Sim *get() const noexcept { return sim_; }

    /** The handle of its model; null if there is no simulation. */
    const typename Api::Model *model() const
    {
        const typename Api::Model *out = nullptr;
        detail::done(Api::sim_model(sim_, &out));
        return out;
    }
    /** Goes on exactly as another simulation of the same model. */
    nekton_status copy_from(const BasicSim &other, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_copy(sim_, other.sim_, d); });
    }

    /** Time of the state shown; NaN if there is no simulation. */
    R time() const
    {
        R t = std::numeric_limits<R>::quiet_NaN();
        detail::done(Api::sim_time(sim_, &t));
        return t;
    }
    /** x, y, theta of every link's centre of mass: 3 numbers per link. */
    nekton_status positions(Span<R> q) const { return detail::done(Api::sim_positions(sim_, q.data(), q.size())); }
    /** Their rates. */
    nekton_status velocities(Span<R> qd) const { return detail::done(Api::sim_velocities(sim_, qd.data(), qd.size())); }
    /** Time and integrated state: plan().state_len numbers. */
    nekton_status state(R &t, Span<R> y) const { return detail::done(Api::sim_get_state(sim_, &t, y.data(), y.size())); }
    /** Sets time and state; the integrator starts anew. */
    nekton_status set_state(R t, Span<const R> y, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_set_state(sim_, t, y.data(), y.size(), d); });
    }
    /** Forgets the integrator's past. */
    nekton_status restart() { return detail::done(Api::sim_restart(sim_)); }
    /** One step of the method. */
    nekton_status step(nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_step(sim_, d); });
    }
    /** Advances to exactly t_end. */
    nekton_status advance(R t_end, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_advance(sim_, t_end, d); });
    }
    /** Shows the state at t_out; the integrator may run ahead, but not beyond t_stop. */
    nekton_status advance_dense(R t_out, R t_stop, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_advance_dense(sim_, t_out, t_stop, d); });
    }
    /** How many steps one advance may make (at first 1000000). */
    nekton_status set_step_limit(std::uint64_t steps)
    {
        return detail::call(nullptr, [&](nekton_diag *) { return Api::sim_set_step_limit(sim_, steps); });
    }
    /** Sets a channel: (t, u, du/dt, d2u/dt2) at both ends of the coming interval. */
    nekton_status set_channel(std::size_t channel, const std::array<R, 4> &from, const std::array<R, 4> &to,
                              nekton_diag *diag = nullptr)
    {
        return detail::call(diag,
                            [&](nekton_diag *d) { return Api::sim_set_channel(sim_, channel, from.data(), to.data(), d); });
    }
    /** dy/dt for an integrator of your own; both of plan().state_len numbers. */
    nekton_status rhs(R t, Span<const R> y, Span<R> ydot, nekton_diag *diag = nullptr)
    {
        return two(y.size(), ydot.size(), diag,
                   [&](nekton_diag *d) { return Api::sim_rhs(sim_, t, y.data(), ydot.data(), ydot.size(), d); });
    }
    /** Value and rate of every joint. */
    nekton_status joint_values(Span<R> u, Span<R> du)
    {
        return two(u.size(), du.size(), nullptr,
                   [&](nekton_diag *) { return Api::sim_joint_values(sim_, u.data(), du.data(), du.size()); });
    }
    /** Torque that drives every joint, and its power. */
    nekton_status joint_torques(Span<R> torque, Span<R> power, nekton_diag *diag = nullptr)
    {
        return two(torque.size(), power.size(), diag,
                   [&](nekton_diag *d) { return Api::sim_joint_torques(sim_, torque.data(), power.data(), power.size(), d); });
    }

    /** Each of these fills 3 numbers per link. */
    nekton_status accelerations(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_accelerations, out, diag); }
    nekton_status christoffel(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_christoffel, out, diag); }
    nekton_status buoyancy(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_buoyancy, out, diag); }
    nekton_status repulsion(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_repulsion, out, diag); }
    nekton_status circulation_gradient(Span<R> out, nekton_diag *diag = nullptr)
    {
        return fill(Api::sim_circulation_gradient, out, diag);
    }
    /** Each of these fills a square matrix of 3 rows per link, column by column. */
    nekton_status mass_matrix(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_mass_matrix, out, diag); }
    nekton_status added_mass(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_added_mass, out, diag); }
    nekton_status gyroscopic(Span<R> out, nekton_diag *diag = nullptr) { return fill(Api::sim_gyroscopic, out, diag); }
    /** The full tensor, (3 links)^3 numbers. */
    nekton_status christoffel_tensor(Span<R> out, nekton_diag *diag = nullptr)
    {
        return fill(Api::sim_christoffel_tensor, out, diag);
    }

    /** Energies at the state shown. */
    nekton_status energy(typename Api::Energy &out, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_energy(sim_, &out, d); });
    }
    /** Linear impulse and angular impulse about the origin. */
    nekton_status impulse(std::array<R, 3> &out, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_impulse(sim_, out.data(), d); });
    }
    /** Error indicators of the steps of the last call that stepped. */
    nekton_status indicators(typename Api::Resolution &out, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_indicators(sim_, &out, d); });
    }
    /** Error indicators of the space discretization at the state shown, from all of the added mass. */
    nekton_status resolution(typename Api::Resolution &out, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_resolution(sim_, &out, d); });
    }
    /** Estimated local errors of time integration since the start. */
    nekton_status time_error(typename Api::TimeError &out) const
    {
        return detail::done(Api::sim_time_error(sim_, &out));
    }
    /** The smallest gap between boundaries of which one moves. */
    nekton_status gap(typename Api::Gap &out, nekton_diag *diag = nullptr)
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_gap(sim_, &out, d); });
    }
    /** What the simulation did since its start; zeros if there is no simulation. */
    nekton_counters counters() const
    {
        nekton_counters out = {};
        detail::done(Api::sim_counters(sim_, &out));
        return out;
    }

private:
    template <class F> nekton_status fill(F function, Span<R> out, nekton_diag *diag)
    {
        return detail::call(diag, [&](nekton_diag *d) { return function(sim_, out.data(), out.size(), d); });
    }
    /** For functions of C with one length for two buffers. */
    template <class F> nekton_status two(std::size_t first, std::size_t second, nekton_diag *diag, F function)
    {
        return detail::call(diag, [&](nekton_diag *d) {
            if (first != second) {
                *d = detail::plain(NEKTON_E_LENGTH);
                return nekton_status{NEKTON_E_LENGTH};
            }
            return function(d);
        });
    }

    typename Api::Sim *sim_ = nullptr;
    bool owned_ = false;
};

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
