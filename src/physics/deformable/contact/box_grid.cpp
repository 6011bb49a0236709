// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/box_grid.h"

namespace embody::physics::deformable {

// Counting sort of the boxes into the cells that they may reach.
void BoxGrid::fill(std::span<const Bounds> boxes, double usual_size) {
    constexpr double cell_fraction = 1.5;  // cells over usual size: the fastest value
    constexpr double max_cells = 8;        // maximum number that a box spans along an axis: bounds the time
    std::size_t buckets = 1;
    while (buckets < 2 * boxes.size()) buckets *= 2;
    double longest = 0;
    for (const Bounds& box : boxes) {
        const Vec3 sides = box.upper - box.lower;
        longest = std::max({longest, sides.x, sides.y, sides.z});
    }
    cell_size_ = std::max(cell_fraction * usual_size, longest / max_cells);
    start_.assign(buckets + 1, 0);
    for (const Bounds& box : boxes) for_each_bucket(box, [&](std::size_t b) { ++start_[b + 1]; });
    for (std::size_t b = 0; b < buckets; ++b) start_[b + 1] += start_[b];
    boxes_.resize(start_.back());
    next_.assign(start_.begin(), start_.end() - 1);
    rounded_.clear();
    for (const Bounds& box : boxes) rounded_.push_back(rounded(box));
    for (std::uint32_t t = 0; t < boxes.size(); ++t)
        for_each_bucket(boxes[t], [&](std::size_t b) { boxes_[next_[b]++] = t; });
}

}  // namespace embody::physics::deformable
