// Calls of C: handles that free themselves, failures that are thrown.

#ifndef PC_CALL_HPP
#define PC_CALL_HPP

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "../pc.h"
#include "catching.hpp"
#include "error.hpp"

namespace pc::detail {

/// An object that C has made, to be freed.
template <class Handle, void (*Free)(Handle *)> class owned {
public:
    owned() noexcept = default;
    owned(const owned &) = delete;
    owned &operator=(const owned &) = delete;
    owned(owned &&other) noexcept : raw_(std::exchange(other.raw_, nullptr)) {}
    owned &operator=(owned &&other) noexcept
    {
        owned taken(std::move(other));
        std::swap(raw_, taken.raw_);
        return *this;
    }
    ~owned() { Free(raw_); }

    Handle *get() const noexcept { return raw_; }
    /// The place where C puts it, once.
    Handle **place() noexcept { return &raw_; }

private:
    Handle *raw_ = nullptr;
};

/// Calls a function with the place of its error last. Throws what a function of the program has
/// thrown during it, even if the call succeeded, or else the failure of the call.
template <class Function, class... Arguments> pc_status call(Function function, Arguments... arguments)
{
    catching thrown;
    owned<pc_error, pc_error_free> said;
    const pc_status status = function(arguments..., said.place());
    thrown.rethrow();
    if (status != PC_OK && status != PC_STOPPED && status != PC_EVENT) {
        throw error(status, said.get());
    }
    return status;
}

/// The object that a function makes.
template <class Owned, class Function, class... Arguments> Owned make(Function function, Arguments... arguments)
{
    Owned made;
    call(function, arguments..., made.place());
    return made;
}

/// The text that a function makes.
template <class Function, class... Arguments> std::string text(Function function, Arguments... arguments)
{
    return make<owned<char, pc_string_free>>(function, arguments...).get();
}

/// The first `count` names of a handle.
template <class Handle, class Name>
std::vector<std::string> names(const Handle *of, Name name, std::size_t count)
{
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; i++) {
        names.emplace_back(name(of, i));
    }
    return names;
}

} // namespace pc::detail

#endif // PC_CALL_HPP
