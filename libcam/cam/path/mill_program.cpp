// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/path/mill_program.h"

namespace cam::path {

std::string_view operation_name(MillOperation operation) {
    switch (operation) {
        case MillOperation::Dowels:
            return "dowels";
        case MillOperation::Rough:
            return "rough";
        case MillOperation::RestRough:
            return "rest-rough";
        case MillOperation::Flats:
            return "flats";
        case MillOperation::Waterline:
            return "waterline";
        case MillOperation::Parallel:
            return "parallel";
        case MillOperation::RestFinish:
            return "rest-finish";
        case MillOperation::Drill:
            return "drill";
        case MillOperation::Contour:
            return "contour";
    }
    return "unknown";
}

}  // namespace cam::path
