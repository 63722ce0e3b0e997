// Exceptions of the program's functions, and where they come out.

#ifndef PC_CATCHING_HPP
#define PC_CATCHING_HPP

#include <exception>
#include <utility>

namespace pc {

/// Keeps exceptions of the program's functions while C code is between them and their caller.
///
/// Forces, events, resets and observers are called by C, through which nothing may be thrown. The
/// youngest catching of the thread keeps what they throw; until it is rethrown, no such function is
/// called again, and each counts as failed. So an exception does not stand for a missing value:
/// where a force or an event has none, its function writes NaN.
///
/// Every call of these headers has its own catching, and throws what that has kept, even where C
/// succeeded in spite of it. A program needs another one where it puts C code in between, such as
/// an integrator that is given pc_kernel_rhs:
///
///     pc::catching thrown;
///     const int status = gsl_odeiv2_driver_apply(driver, &t, 1.0, y);
///     thrown.rethrow();
///
/// Without one, the function of C fails and the exception is lost.
class catching {
public:
    catching() noexcept : outer_(std::exchange(youngest(), this)) {}
    ~catching() { youngest() = outer_; }
    catching(const catching &) = delete;
    catching &operator=(const catching &) = delete;

    /// Throws the exception that is kept, if any.
    void rethrow()
    {
        if (thrown_) {
            std::rethrow_exception(std::exchange(thrown_, nullptr));
        }
    }

    /// What `body` returns to C, or `otherwise` if it throws or something has been thrown before.
    template <class Body> static int guard(int otherwise, Body body) noexcept
    {
        catching *const call = youngest();
        if (call && call->thrown_) {
            return otherwise;
        }
        try {
            return body();
        } catch (...) {
            if (call && !call->thrown_) {
                call->thrown_ = std::current_exception();
            }
            return otherwise;
        }
    }

private:
    static catching *&youngest() noexcept
    {
        thread_local catching *of_thread = nullptr;
        return of_thread;
    }

    catching *outer_;
    std::exception_ptr thrown_{};
};

} // namespace pc

#endif // PC_CATCHING_HPP
