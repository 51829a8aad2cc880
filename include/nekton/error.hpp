/** Part of nekton.hpp: errors as exceptions, or without. */
#ifndef NEKTON_ERROR_HPP
#define NEKTON_ERROR_HPP

#include "../nekton.h"

#include <limits>

#if !defined(NEKTON_NO_EXCEPTIONS) && !defined(__cpp_exceptions)
#define NEKTON_NO_EXCEPTIONS
#endif
#ifndef NEKTON_NO_EXCEPTIONS
#include <exception>
#endif

namespace nekton {

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
    char text_[256] = {};
};
#endif

namespace detail {

/** A diag for an error that has no place. */
inline nekton_diag plain(nekton_status status) noexcept
{
    const nekton_place nowhere = {NEKTON_PLACE_NONE, -1, -1};
    nekton_diag diag = {};
    diag.status = status;
    diag.place = diag.other = nowhere;
    diag.item = -1;
    diag.value = diag.limit = diag.time = std::numeric_limits<double>::quiet_NaN();
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

} // namespace nekton

#endif /* NEKTON_ERROR_HPP */
