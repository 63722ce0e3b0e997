// Calls that failed.

#ifndef PC_ERROR_HPP
#define PC_ERROR_HPP

#include <cstddef>
#include <stdexcept>

#include "../pc.h"

namespace pc {

/// A call that failed; what() is the message, which for a model shows the line at fault and what
/// would be right.
class error : public std::runtime_error {
public:
    /// From a status that is a failure, and the error of the call, which may be null.
    error(pc_status status, const pc_error *said)
        : std::runtime_error(said ? pc_error_message(said) : pc_status_name(status)),
          status_(status),
          line_(pc_error_line(said)),
          column_(pc_error_column(said)),
          offset_(pc_error_offset(said)),
          length_(pc_error_length(said)),
          integrator_code_(pc_error_integrator_code(said)),
          recoverable_(pc_error_is_recoverable(said) != 0)
    {
    }

    pc_status status() const noexcept { return status_; }
    /// The place in the model text, from 1; 0 if there is none.
    std::size_t line() const noexcept { return line_; }
    std::size_t column() const noexcept { return column_; }
    /// The bytes at fault, from 0, and their number.
    std::size_t offset() const noexcept { return offset_; }
    std::size_t length() const noexcept { return length_; }
    /// The code of CVODES, or 0.
    int integrator_code() const noexcept { return integrator_code_; }
    /// Whether evaluation may succeed at a nearby state.
    bool is_recoverable() const noexcept { return recoverable_; }

private:
    pc_status status_;
    std::size_t line_, column_, offset_, length_;
    int integrator_code_;
    bool recoverable_;
};

} // namespace pc

#endif // PC_ERROR_HPP
