// SPDX-License-Identifier: GPL-2.0-or-later
// The light sampler contract. A sampler is one file shaders/light_samplers/NAME.glsl; NAME is the value of
// pt_light_sampler. It includes lib/light_sampler.glsl, or a library that does, and defines
//
//     const uint light_sampler_traits = SAMPLER_... | SAMPLER_...;
//         on one line: the build reads it, too. 0: none.
//     LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
//         Picks an emitter of the list for surface `s`. Its report makes f(point) / (density of the point *
//         probability) an unbiased estimate of the light of all emitters. Nothing to pick: no_light().
//     float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
//         The probability with which sample_light picks `emitter` (0: never, or not in the list), all random choices
//         that do not decide about this emitter taken as given by `random`. Averaged over `random` it is the frequency.
//
// What MIS asks for (section 47.5.3): let `random` consist of some numbers U that the probability depends on and of
// others that it is averaged over. Then sample_light must report light_probability of what it picked, for the same U,
// and the two functions may be called with different random numbers: for each emitter, E[report; picked] over
// sample_light and E[light_probability ...] weigh the same point alike. A sampler for which the reported probability is
// not the average over all choices that bring the emitter in is biased under MIS (subset_mis_biased shows it).
//
// Lists are sorted ascending by emitter index and hold no emitter twice. light_contribution() is the weight to choose
// by. Files must compile as GLSL and as C++ (functions.h); the tests check every file that the build finds.
#ifndef VKPT_SHARED_LIGHT_SAMPLER_H
#define VKPT_SHARED_LIGHT_SAMPLER_H

#include "language.h"

VKPT_SHARED_BEGIN

// BSDF rays that meet an emitter count, too, and both are weighted by mis_weight (lib/lighting.glsl). Without: light
// sampling alone accounts for the lists' emitters.
VKPT_CONST uint SAMPLER_MIS = 1u;
// There to be compared: its images are wrong.
VKPT_CONST uint SAMPLER_BIASED = 2u;
// pt_light_subset means something to it.
VKPT_CONST uint SAMPLER_USES_SUBSET = 4u;
// It picks an entry of a multiset, of which a light may have several: light_probability is then of one at random.
VKPT_CONST uint SAMPLER_DRAWS_ENTRIES = 8u;
// It chooses the point, too, and never a light at a point that sends nothing: what it reports is no probability of the
// light.
VKPT_CONST uint SAMPLER_DRAWS_POINTS = 16u;
// What it reports depends on the list's length whatever the lights: where A-SVGF repeats an older sample, it is asked
// about the lights that its list held, and once more about those that have come. Without MIS only.
VKPT_CONST uint SAMPLER_NEWCOMERS_APART = 32u;
// The weights that it chooses by are those of weigh_emitter, so that options.hidden counts. Without MIS only: a later
// pass does not know it.
VKPT_CONST uint SAMPLER_WEIGHS_VISIBILITY = 256u;
// The tables beside the lists that it reads: the device has them only for samplers that say so.
#define VKPT_SAMPLER_NEED(trait, bit, make) VKPT_CONST uint trait = bit;
#include "sampler_tables.def"

VKPT_CONST uint SAMPLER_NEEDS = 0u
#define VKPT_SAMPLER_NEED(trait, bit, make) | trait
#include "sampler_tables.def"
    ;

VKPT_SHARED_END

#endif
