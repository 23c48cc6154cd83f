// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fields.h"
#include "cam/profile/link.h"

#include <vector>

namespace cam::profile {

[[nodiscard]] std::vector<Field> fields_of(Link& link);

}  // namespace cam::profile
