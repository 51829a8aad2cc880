/** Part of nekton.hpp: buffers that know their length. */
#ifndef NEKTON_SPAN_HPP
#define NEKTON_SPAN_HPP

#include <cstddef>
#include <type_traits>
#include <utility>

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

} // namespace nekton

#endif /* NEKTON_SPAN_HPP */
