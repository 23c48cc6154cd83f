// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cam/profile/fdm_machine.h"
#include "decomp/base/result.h"
#include "decomp/base/run.h"

#include <filesystem>

namespace cam::post {

/// Runs the machine's converter (e.g. gpx) on a finished program, without a shell. The result
/// appears under its name whole or not at all; what is there already is replaced. Waits at most
/// `kConverterSeconds`.
/// @error post.no_converter, post.converter_missing (with the package to install),
/// post.converter_failed (with what the converter said), post.converter_timeout, file.not_found,
/// file.unwritable, run.cancelled
[[nodiscard]] decomp::Status convert(const std::filesystem::path& program,
                                     const std::filesystem::path& out,
                                     const profile::FdmMachine::Converter& converter,
                                     const decomp::Run& run = {});

constexpr int kConverterSeconds = 120;

}  // namespace cam::post
