// Views of numbers that another object owns, which functions read and write.

#ifndef PC_VIEW_HPP
#define PC_VIEW_HPP

#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

namespace pc {

/// Owned numbers: what functions return.
using vector = std::vector<double>;

/// A pointer and a length. It owns nothing, and is valid as long as what it was made from: a
/// vector, an array, an array of C, a std::span, another view, or, for reading, a list in braces.
/// Calls check lengths.
template <class T> class view {
    template <class Container>
    using of = std::enable_if_t<
        std::is_convertible_v<std::remove_pointer_t<decltype(std::declval<Container>().data())> (*)[], T (*)[]>>;
    template <class U> using read_only = std::enable_if_t<std::is_const_v<U>>;

public:
    using value_type = std::remove_cv_t<T>;

    constexpr view() noexcept = default;
    constexpr view(T *data, std::size_t size) noexcept : data_(data), size_(size) {}
    template <std::size_t N> constexpr view(T (&array)[N]) noexcept : data_(array), size_(N) {}
    template <class Container, class = of<Container &>>
    constexpr view(Container &container) noexcept : data_(container.data()), size_(container.size())
    {
    }
    template <class Container, class = of<const Container &>>
    constexpr view(const Container &container) noexcept : data_(container.data()), size_(container.size())
    {
    }
    template <class U = T, class = read_only<U>>
    constexpr view(std::initializer_list<value_type> list) noexcept : data_(std::data(list)), size_(list.size())
    {
    }

    constexpr T *data() const noexcept { return data_; }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr bool empty() const noexcept { return size_ == 0; }
    constexpr T *begin() const noexcept { return data_; }
    constexpr T *end() const noexcept { return data_ + size_; }
    constexpr T &operator[](std::size_t i) const noexcept { return data_[i]; }

private:
    T *data_ = nullptr;
    std::size_t size_ = 0;
};

} // namespace pc

#endif // PC_VIEW_HPP
