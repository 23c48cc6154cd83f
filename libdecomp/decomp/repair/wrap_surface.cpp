// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/repair/distance.h"
#include "decomp/repair/work.h"
#include "decomp/repair/wrap.h"

namespace decomp::repair {

namespace {

constexpr double kOffsetShare = 1.0 / 30;  // of alpha
constexpr double kProbeShare = 1.0 / 20;   // of the diagonal: alpha of the coarsest wrap
constexpr double kLeastVolumeKept =
    0.7;  // when alpha is halved; a sheet keeps half, a solid all but its rounding

Result<mesh::TriMesh> wrapped(const Work& work, const mesh::TriMesh& soup, double share) {
    if (work.run.cancelled()) {
        return cancelled();
    }
    const double alpha_mm = share * mesh::diagonal_mm(soup);
    return wrap(soup, alpha_mm, kOffsetShare * alpha_mm);
}

tl::unexpected<Error> not_a_solid(const Work& work, double coarse_mm3, double fine_mm3) {
    return fail("repair.not_a_solid",
                work.wrap_reason + "; a wrap of it shrinks from " + figure(coarse_mm3) + " to " +
                    figure(fine_mm3) + " mm^3 as it gets finer, so it encloses nothing",
                "", "give the shape a thickness, or close it, in a modeller");
}

}  // namespace

decomp::Status wrap_surface(Work& work, const mesh::TriMesh& soup) {
    if (!work.options.allow_wrap) {
        return fail("repair.wrap_needed", work.wrap_reason, "",
                    "mend the mesh in a modeller, or allow wrapping");
    }
    // Two coarse wraps cost little and tell a sheet, whose wrap is as thick as its offset, from a
    // body.
    double volume_mm3 = 0;
    Result<mesh::TriMesh> fine;
    for (const double share : {kProbeShare, kProbeShare / 2, work.options.wrap_detail_share}) {
        fine = wrapped(work, soup, share);
        if (!fine) {
            return fail(fine.error());
        }
        const double finer_mm3 = mesh::volume_mm3(*fine);
        if (finer_mm3 < kLeastVolumeKept * volume_mm3) {
            return not_a_solid(work, volume_mm3, finer_mm3);
        }
        volume_mm3 = finer_mm3;
    }
    const double fine_mm = work.options.wrap_detail_share * mesh::diagonal_mm(soup);
    work.mesh = std::move(*fine);
    work.surface_moved = true;
    work.change(Status::Wrapped, "replaced the surface by a wrap with " +
                                     counted(work.mesh.triangles.size(), "triangle") +
                                     " that bridges gaps up to " + figure(fine_mm) +
                                     " mm, because " + work.wrap_reason);
    return {};
}

}  // namespace decomp::repair
