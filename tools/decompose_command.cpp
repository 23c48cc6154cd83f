// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/job_options.h"

namespace tools {

Action declare_decompose(CLI::App& app, const Common& common) {
    return declare_job(app, common, cam::job::Extent::Parts);
}

}  // namespace tools
