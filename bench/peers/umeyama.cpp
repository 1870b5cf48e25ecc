// Eigen's umeyama solves each particle's turn from its neighbours in the reference and in this picture.
// Arguments: POSITIONS REFERENCE LISTS ROWS ANGLES.
#include <cmath>

#include <Eigen/Dense>

#include "rounds.hpp"

constexpr int K = 48;

int main(int count, char **arguments) {
  if (count != 6) return 2;
  const auto positions = read_array<float>(arguments[1]), reference = read_array<float>(arguments[2]);
  const auto lists = read_array<uint32_t>(arguments[3]);
  const auto rows = read_array<float>(arguments[4]);
  const int particles = int(positions.size() / 3);
  std::vector<float> now(2 * particles), angles(particles);
  auto task = [&] {
#pragma omp parallel for
    for (int i = 0; i < particles; i++) {
      const float *p = &positions[3 * i], *r = rows.data();
      const float w = 1.0f / (r[8] * p[0] + r[9] * p[1] + r[10] * p[2] + r[11]);
      now[2 * i] = (r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3]) * w;
      now[2 * i + 1] = (r[4] * p[0] + r[5] * p[1] + r[6] * p[2] + r[7]) * w;
    }
#pragma omp parallel for
    for (int i = 0; i < particles; i++) {
      Eigen::Matrix<float, 2, K> from, to;
      for (int k = 0; k < K; k++) {
        const size_t other = lists[size_t(K) * i + k];
        from.col(k) << reference[2 * other] - reference[2 * i], reference[2 * other + 1] - reference[2 * i + 1];
        to.col(k) << now[2 * other] - now[2 * i], now[2 * other + 1] - now[2 * i + 1];
      }
      const Eigen::Matrix3f map = Eigen::umeyama(from, to, true);
      angles[i] = std::atan2(map(1, 0), map(0, 0));
    }
  };
  task();
  write_array(arguments[5], angles);
  return serve(task);
}
