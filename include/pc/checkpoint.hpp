// Checkpoints, from which integrations are resumed.

#ifndef PC_CHECKPOINT_HPP
#define PC_CHECKPOINT_HPP

#include <string>
#include <vector>

#include "../pc.h"
#include "call.hpp"
#include "view.hpp"

namespace pc {

/// What solver::checkpoint writes and solver::restore reads.
using bytes = std::vector<unsigned char>;

/// The label of a checkpoint.
inline std::string checkpoint_label(view<const unsigned char> checkpoint)
{
    return detail::text(pc_checkpoint_label, checkpoint.data(), checkpoint.size());
}

} // namespace pc

#endif // PC_CHECKPOINT_HPP
