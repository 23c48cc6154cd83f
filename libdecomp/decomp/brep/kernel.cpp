// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/brep/kernel_detail.h"

#include <dlfcn.h>

namespace decomp::brep {

namespace {

Result<const Kernel*> load() {
    // Found along the program's run path; stays loaded.
    void* module = ::dlopen(kKernelModule, RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) {
        const char* reason = ::dlerror();
        return fail("brep.kernel",
                    std::string("the geometry kernel cannot be loaded: ") +
                        (reason != nullptr ? reason : "unknown reason"),
                    kKernelModule, "install Hew as a whole, with its folder lib/hew");
    }
    void* entry = ::dlsym(module, kKernelEntry);
    if (entry == nullptr) {
        return fail("brep.kernel", "the geometry kernel's module is of another version",
                    kKernelModule, "install Hew as a whole, with its folder lib/hew");
    }
    return reinterpret_cast<KernelEntry>(entry)();
}

}  // namespace

Result<const Kernel*> kernel() {
    static const Result<const Kernel*> kLoaded = load();
    return kLoaded;
}

}  // namespace decomp::brep
