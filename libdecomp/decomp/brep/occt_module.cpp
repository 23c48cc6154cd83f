// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/brep/kernel_detail.h"
#include "decomp/brep/occt_detail.h"

extern "C" __attribute__((visibility("default"))) const decomp::brep::Kernel* hew_occt_kernel() {
    static const decomp::brep::Kernel kKernel{&decomp::brep::read_with_occt,
                                              &decomp::brep::write_with_occt};
    return &kKernel;
}
