/** Part of nekton.hpp: compiled scenes. */
#ifndef NEKTON_MODEL_HPP
#define NEKTON_MODEL_HPP

#include "api.hpp"
#include "error.hpp"

#include <array>
#include <cstddef>
#include <utility>

namespace nekton {

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
    /** Relative error that may come from what is between the points of a curve; -1 for other shapes. */
    nekton_status outline_error(const nekton_place &place, R &out) const
    {
        return detail::done(Api::model_outline_error(model_, &place, &out));
    }
    /** Point of an outline at a parameter in [0, 2 pi). */
    nekton_status outline_point(const nekton_place &place, R t, std::array<R, 2> &out) const
    {
        return detail::done(Api::model_outline_point(model_, &place, t, out.data()));
    }
    /** Memory that linearize and force_derivatives of its simulations need. */
    nekton_status derivatives_req(nekton_req &out, nekton_diag *diag = nullptr) const
    {
        return detail::call(diag, [&](nekton_diag *d) { return Api::sim_derivatives_req(model_, &out, d); });
    }

private:
    typename Api::Model *model_ = nullptr;
    bool owned_ = false;
};

} // namespace nekton

#endif /* NEKTON_MODEL_HPP */
