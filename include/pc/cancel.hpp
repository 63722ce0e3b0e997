// Limits of derivations and integrations, and their cancellation.

#ifndef PC_CANCEL_HPP
#define PC_CANCEL_HPP

#include <cstdint>

#include "../pc.h"
#include "call.hpp"

namespace pc {

/// Ends derivations and integrations, from another thread or a signal handler.
class cancel {
public:
    cancel() : handle_(detail::make<handle>(pc_cancel_new)) {}

    /// Ends those under way and those that begin later.
    void request() const noexcept { pc_cancel_request(get()); }
    bool is_requested() const noexcept { return pc_cancel_is_requested(get()) != 0; }
    const pc_cancel *get() const noexcept { return handle_.get(); }

private:
    using handle = detail::owned<pc_cancel, pc_cancel_free>;

    handle handle_{};
};

/// Limits of each derivation, and of each call of a solver or an ensemble.
struct limits {
    /// The most bytes that expressions may take; 0 for 4 GiB.
    std::uint64_t memory = 0;
    /// The most seconds; 0 for no limit.
    double time = 0.0;
    /// Ends them, unless null; it may be destroyed once the system is made.
    const cancel *by = nullptr;
};

} // namespace pc

#endif // PC_CANCEL_HPP
