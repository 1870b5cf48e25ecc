// What every peer in C++ shares: arrays in files, the order of points along Morton's curve, and rounds on demand.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <parallel/algorithm>
#include <string>
#include <utility>
#include <vector>

template <class T> std::vector<T> read_array(const char *path) {
  FILE *file = std::fopen(path, "rb");
  if (!file) {
    std::fprintf(stderr, "%s cannot be read\n", path);
    std::exit(1);
  }
  std::fseek(file, 0, SEEK_END);
  std::vector<T> array(std::ftell(file) / sizeof(T));
  std::rewind(file);
  if (std::fread(array.data(), sizeof(T), array.size(), file) != array.size()) std::exit(1);
  std::fclose(file);
  return array;
}

template <class T> void write_array(const char *path, const std::vector<T> &array) {
  FILE *file = std::fopen(path, "wb");
  if (!file || std::fwrite(array.data(), sizeof(T), array.size(), file) != array.size() || std::fclose(file)) {
    std::fprintf(stderr, "%s cannot be written\n", path);
    std::exit(1);
  }
}

inline uint32_t spread(uint32_t bits) {
  bits &= 0x3ff;
  bits = (bits | (bits << 16)) & 0x030000ff;
  bits = (bits | (bits << 8)) & 0x0300f00f;
  bits = (bits | (bits << 4)) & 0x030c30c3;
  return (bits | (bits << 2)) & 0x09249249;
}

/// Indices of points (x, y, z each) along the curve.
inline std::vector<uint32_t> morton_order(const std::vector<float> &points) {
  const size_t count = points.size() / 3;
  float low[3] = {1e30f, 1e30f, 1e30f}, extent = 1e-30f;
  for (size_t i = 0; i < points.size(); i++) low[i % 3] = std::min(low[i % 3], points[i]);
  for (size_t i = 0; i < points.size(); i++) extent = std::max(extent, points[i] - low[i % 3]);
  const float scale = 1023.0f / extent;
  std::vector<uint64_t> keys(count);
#pragma omp parallel for
  for (size_t i = 0; i < count; i++) {
    uint32_t code = 0;
    for (int axis = 0; axis < 3; axis++)
      code |= spread(uint32_t((points[3 * i + axis] - low[axis]) * scale)) << axis;
    keys[i] = uint64_t(code) << 32 | i;
  }
  __gnu_parallel::sort(keys.begin(), keys.end());
  return std::vector<uint32_t>(keys.begin(), keys.end());
}

/// Prints that it is ready. Then for each line `go N` it does the task N times and prints how long that took.
template <class Task> int serve(Task task) {
  std::puts("{\"ready\": true}");
  std::fflush(stdout);
  int times = 0;
  while (std::scanf(" go %d", &times) == 1) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < times; i++) task();
    const std::chrono::duration<double> secs = std::chrono::steady_clock::now() - start;
    std::printf("{\"secs\": %.9f}\n", secs.count());
    std::fflush(stdout);
  }
  return 0;
}
