// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/brep/read_brep.h"
#include "decomp/brep/write_step.h"

namespace decomp::brep {

/// What the module that links the geometry kernel offers. It is built with this room and loaded
/// when first called, so that programs which meet no STEP file do not pay for the kernel.
struct Kernel {
    Result<std::vector<Body>> (*read)(std::string_view bytes, FileKind kind, std::string_view name,
                                      const BrepReadOptions& options, const Run& run);
    Result<StepFile> (*write)(const std::vector<StepBody>& bodies, const std::string& title,
                              StepSchema schema, const Run& run);
};

using KernelEntry = const Kernel* (*)();

inline constexpr const char* kKernelModule = "hew_occt.so";
inline constexpr const char* kKernelEntry = "hew_occt_kernel";

/// The kernel, loaded on the first call; thread-safe. @error brep.kernel
[[nodiscard]] Result<const Kernel*> kernel();

}  // namespace decomp::brep
