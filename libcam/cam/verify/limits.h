// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// What a proof lets pass. The figures in the comments are those of PrusaSlicer 2.5 and
/// CuraEngine 4.13 on good parts.
namespace cam::verify::limits {

inline constexpr double kChamberSlackMm = 0.0015;  ///< rounding of printed coordinates
inline constexpr double kFlowSlack = 1.02;         ///< of the flow limit
inline constexpr double kBelowSlackMm = 0.05;      ///< nozzle under the top of printed material
inline constexpr double kNozzleSlackCelsius = 30;  ///< below the material's temperature
inline constexpr double kBlobMm3 = 0.6;            ///< one push at a standstill; peers 0
inline constexpr double kPrimeMm3 = 60;  ///< pushed at a standstill before the first bead; Cura 7.2
inline constexpr double kRingOuterMm = 0.1;  ///< the skin ring, inside the surface
inline constexpr double kRingInnerMm = 0.35;
inline constexpr double kSkinMm2 = 1.0;      ///< uncovered ring of one layer; peers 0
inline constexpr double kSkinShare = 0.005;  ///< and of its ring
inline constexpr double kOutsideMm = 0.15;   ///< a bead may swell that far out of the part
inline constexpr double kOutsideLayerMm3 =
    0.25;  ///< undeclared material outside, one layer; peers 0.01
inline constexpr double kOutsideShare = 0.0005;  ///< of the part's material; peers 0.000011
inline constexpr double kContactLayers = 2;  ///< free layers between a support and what it carries
inline constexpr double kContactSlackMm = 0.06;
inline constexpr double kIslandMm2 = 0.3;         ///< smaller specks of the part are no island
inline constexpr double kSupportIslandMm2 = 2.0;  ///< nor are these of supports: a lost thread
inline constexpr double kHangingMm = 3.0;         ///< free overhang of one layer
inline constexpr double kHangingMm2 = 4.0;        ///< beyond that, one layer; peers 0
inline constexpr double kAnchorMm = 1.0;  ///< ends of bridges lie that near to what carries them
inline constexpr double kSolidCoverage =
    0.985;                                     ///< covered share of a section that counts as solid
inline constexpr double kLeastSolidMm2 = 100;  ///< smaller sections say little about the flow
inline constexpr double kBridgeShare =
    0.02;  ///< of the beads over nothing, in a layer judged for its flow
inline constexpr double kFillLow = 0.94;  ///< V / (A h); peers 1.001 .. 1.007
inline constexpr double kFillHigh = 1.05;
inline constexpr double kHoleMm = 0.35;          ///< of a round hole's diameter; peers 0.15
inline constexpr double kFirstLayerShare = 0.8;  ///< of a solid foot that must touch the bed
inline constexpr double kMissingLayers =
    1.6;  ///< step between two layers of a part, in layer heights
inline constexpr double kPresence =
    0.02;  ///< covered share of a section that makes a layer of a part
inline constexpr double kPrintableMm2 = 1.0;  ///< smaller sections need not be printed
inline constexpr int kFaultsPerCode = 12;     ///< further ones are counted in a note

}  // namespace cam::verify::limits
