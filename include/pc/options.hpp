// Options of an integration.

#ifndef PC_OPTIONS_HPP
#define PC_OPTIONS_HPP

#include <vector>

#include "../pc.h"
#include "view.hpp"

namespace pc {

/// The options of an integration, at first the defaults; pc.h describes them.
struct solver_options : pc_solver_options {
    /// One for each component, or none, for `absolute_tolerance` for all. It replaces the pointer
    /// in C.
    vector absolute_tolerances{};
    /// A pc_inequality for each component, or none. It replaces the pointer in C.
    std::vector<int> inequalities{};

    solver_options() noexcept { pc_solver_options_init(this, sizeof(pc_solver_options)); }

    /// The options for C, valid as long as this object.
    pc_solver_options get() const noexcept
    {
        pc_solver_options options = *this;
        options.absolute_tolerances = absolute_tolerances.empty() ? nullptr : absolute_tolerances.data();
        options.absolute_tolerances_length = absolute_tolerances.size();
        options.inequalities = inequalities.empty() ? nullptr : inequalities.data();
        options.inequalities_length = inequalities.size();
        return options;
    }
};

} // namespace pc

#endif // PC_OPTIONS_HPP
