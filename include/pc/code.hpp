// Derived models that threads share, and that are kept for the next run.

#ifndef PC_CODE_HPP
#define PC_CODE_HPP

#include <cstddef>
#include <utility>

#include "../pc.h"
#include "call.hpp"
#include "cancel.hpp"
#include "checkpoint.hpp"
#include "model.hpp"
#include "view.hpp"

namespace pc {
namespace detail {

inline pc_system_options options(pc_form form, const limits &within)
{
    pc_system_options options;
    pc_system_options_init(&options, sizeof options);
    options.form = form;
    options.memory_limit = within.memory;
    options.time_limit = within.time;
    options.cancel = within.by == nullptr ? nullptr : within.by->get();
    return options;
}

} // namespace detail

/// The equations of a model, derived and compiled: what its systems have in common. It never
/// changes, and any number of threads may use it at once. Systems outlive it.
///
///     const pc::code bicycle(pc::model::builtin("whipple-bicycle"));
///     pc::system mine(bicycle); // in each thread
class code {
public:
    explicit code(const model &of, pc_form form = PC_POINCARE, const limits &within = {})
    {
        const pc_system_options options = detail::options(form, within);
        detail::call(pc_code_new, of.get(), &options, handle_.place());
    }
    /// What save() has written. Throws PC_INVALID_CODE for anything else.
    static code load(view<const unsigned char> saved)
    {
        return code(detail::make<handle>(pc_code_load, saved.data(), saved.size()));
    }

    /// The bytes for load(), with whatever has been derived on first use so far.
    bytes save() const
    {
        std::size_t length = 0;
        detail::owned<void, pc_bytes_free> data;
        detail::call(pc_code_save, get(), data.place(), &length);
        const auto *first = static_cast<const unsigned char *>(data.get());
        return bytes(first, first + length);
    }
    pc_code *get() const noexcept { return handle_.get(); }

private:
    using handle = detail::owned<pc_code, pc_code_free>;

    explicit code(handle made) noexcept : handle_(std::move(made)) {}

    handle handle_{};
};

} // namespace pc

#endif // PC_CODE_HPP
