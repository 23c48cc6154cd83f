// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/mill/maps.h"
#include "cam/mill/setup.h"
#include "cam/mill/task.h"
#include "cam/mill/writer.h"

namespace cam::mill {

/// A set-up while it is milled: what is asked for, the moves so far and the stock that they leave.
struct Work {
    const Bench& bench;
    const MillTask& task;
    Writer& writer;
    StockMaps& maps;
};

}  // namespace cam::mill
