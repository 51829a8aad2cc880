/** Part of nekton.hpp: what a scene and an integration method are made of. */
#ifndef NEKTON_DEFINITIONS_HPP
#define NEKTON_DEFINITIONS_HPP

#include "api.hpp"
#include "error.hpp"
#include "span.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace nekton {

namespace detail {

/** Fills a definition with defaults and its size. */
template <class Def> void filled(nekton_status (*init)(Def *, std::size_t, std::uint32_t), Def *def)
{
    done(init(def, sizeof(Def), NEKTON_ABI_VERSION));
}

} // namespace detail

/** How a simulation is integrated in time; all fields of nekton_method. */
template <class R> struct BasicMethod : detail::Api<R>::Method {
    /** Variable order and step, both tolerances 1e-9 (single precision: 1e-4). */
    BasicMethod() { detail::filled<Def>(detail::Api<R>::method_init, this); }
    /** Classical Runge-Kutta of order 4 with a fixed step. */
    static BasicMethod rk4(R step) { return fixed(NEKTON_METHOD_RK4, step); }
    /** Adams-Bashforth-Moulton of order 4 with a fixed step. */
    static BasicMethod abm4(R step) { return fixed(NEKTON_METHOD_ABM4, step); }
    /** Implicit Gauss-Legendre of order 6 with a fixed step: the energy does not drift. */
    static BasicMethod gauss6(R step) { return fixed(NEKTON_METHOD_GAUSS6, step); }
    /** Variable order and step; both tolerances, the longest step (0: none) and the first one to be tried (0: chosen). */
    static BasicMethod adams(R tolerance, R max_step = 0, R first_step = 0)
    {
        BasicMethod method;
        method.relative = method.absolute = tolerance;
        method.max_step = max_step;
        method.first_step = first_step;
        return method;
    }

private:
    using Def = typename detail::Api<R>::Method;
    static BasicMethod fixed(std::int32_t kind, R step)
    {
        BasicMethod method;
        method.kind = kind;
        method.step = step;
        return method;
    }
};

/** A link definition, filled with defaults; all fields of nekton_link_def. */
template <class R> struct BasicLink : detail::Api<R>::Link {
    BasicLink() { detail::filled<typename detail::Api<R>::Link>(detail::Api<R>::link_init, this); }
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
    BasicWall() { detail::filled<typename detail::Api<R>::Wall>(detail::Api<R>::wall_init, this); }
};

/** A body definition, filled with defaults; all fields of nekton_body_def. Its links must stay until the model is made. */
template <class R> struct BasicBody : detail::Api<R>::Body {
    BasicBody() { detail::filled<typename detail::Api<R>::Body>(detail::Api<R>::body_init, this); }
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
        detail::filled<typename detail::Api<R>::Scene>(detail::Api<R>::scene_init, this);
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

} // namespace nekton

#endif /* NEKTON_DEFINITIONS_HPP */
