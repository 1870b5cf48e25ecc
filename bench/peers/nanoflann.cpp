// nanoflann's kd-tree finds all points within the radius; the nearest MOST of them are kept.
// Arguments: POINTS RADIUS MOST FOUND.
#include <nanoflann.hpp>

#include "rounds.hpp"

struct Cloud {
  const std::vector<float> &points;
  size_t kdtree_get_point_count() const { return points.size() / 3; }
  float kdtree_get_pt(size_t index, size_t axis) const { return points[3 * index + axis]; }
  template <class Box> bool kdtree_get_bbox(Box &) const { return false; }
};

using Metric = nanoflann::L2_Simple_Adaptor<float, Cloud>;
using Tree = nanoflann::KDTreeSingleIndexAdaptor<Metric, Cloud, 3, uint32_t>;

// Collects all points within the radius, in no order.
struct Within {
  using DistanceType = float;
  using IndexType = uint32_t;
  float radius_sq;
  uint32_t itself;
  std::vector<std::pair<float, uint32_t>> &found;
  bool addPoint(float distance_sq, uint32_t index) {
    // The worst distance is just above the radius, so that the radius itself is within.
    if (distance_sq <= radius_sq && index != itself) found.emplace_back(distance_sq, index);
    return true;
  }
  float worstDist() const { return radius_sq * 1.000001f; }
  size_t size() const { return found.size(); }
  bool full() const { return true; }
  bool empty() const { return found.empty(); }
  void sort() {}
};

struct Lists {
  std::vector<uint32_t> order, starts, indices;
};

int main(int count, char **arguments) {
  if (count != 5) return 2;
  const auto points = read_array<float>(arguments[1]);
  const float radius = std::strtof(arguments[2], nullptr);
  const size_t most = std::strtoul(arguments[3], nullptr, 10);
  const size_t particles = points.size() / 3, chunk = 2048;
  const Cloud cloud{points};
  Lists lists;
  auto task = [&] {
    nanoflann::KDTreeSingleIndexAdaptorParams params(16);
    Tree tree(3, cloud, params);
    tree.buildIndex();
    lists.order = morton_order(points);
    const size_t chunks = (particles + chunk - 1) / chunk;
    std::vector<std::vector<uint32_t>> lengths(chunks), parts(chunks);
#pragma omp parallel
    {
      std::vector<std::pair<float, uint32_t>> found;
#pragma omp for schedule(dynamic)
      for (size_t part = 0; part < chunks; part++) {
        parts[part].reserve(chunk * most);
        for (size_t at = part * chunk; at < std::min(particles, (part + 1) * chunk); at++) {
          const uint32_t query = lists.order[at];
          found.clear();
          Within within{radius * radius, query, found};
#if NANOFLANN_VERSION >= 0x150
          tree.findNeighbors(within, &points[3 * query], nanoflann::SearchParameters(0, false));
#else
          tree.findNeighbors(within, &points[3 * query], nanoflann::SearchParams(32, 0, false));
#endif
          if (found.size() > most) {
            std::nth_element(found.begin(), found.begin() + most, found.end());
            found.resize(most);
          }
          lengths[part].push_back(found.size());
          for (const auto &near : found) parts[part].push_back(near.second);
        }
      }
    }
    lists.starts.assign(1, 0);
    lists.indices.clear();
    for (size_t part = 0; part < chunks; part++) {
      lists.indices.insert(lists.indices.end(), parts[part].begin(), parts[part].end());
      for (uint32_t length : lengths[part]) lists.starts.push_back(lists.starts.back() + length);
    }
  };
  task();
  std::vector<uint32_t> answer(2 * particles);
  for (size_t at = 0; at < particles; at++) {
    const uint32_t particle = lists.order[at];
    answer[particle] = lists.starts[at + 1] - lists.starts[at];
    for (uint32_t i = lists.starts[at]; i < lists.starts[at + 1]; i++) answer[particles + particle] += lists.indices[i];
  }
  write_array(arguments[4], answer);
  return serve(task);
}
