#include "generate/disc_growth.hpp"

#include "packing/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainlaw::core {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();
// Between two scalings of the velocities, per disc.
constexpr long collisions_per_block = 20;
// Reduced pressure at which the discs count as jammed: gaps are about a diameter over it.
constexpr double jammed_pressure = 1e4;
constexpr long most_collisions_per_disc = 200000;

}  // namespace

std::size_t DiscGrowth::bucket(long a, long b) const {
  const auto wrap = [&](long k) { return (k % cells_ + cells_) % cells_; };
  return static_cast<std::size_t>(wrap(a) + cells_ * wrap(b));
}

template <class Visit>
void DiscGrowth::for_neighbours(const Disc& disc, const Visit& visit) const {
  for (long b = disc.cell[1] - 1; b <= disc.cell[1] + 1; ++b)
    for (long a = disc.cell[0] - 1; a <= disc.cell[0] + 1; ++a)
      for (const int j : members_[bucket(a, b)]) {
        const Disc& other = discs_[static_cast<std::size_t>(j)];
        visit(static_cast<std::size_t>(j),
              std::array{(a - other.cell[0]) / cells_, (b - other.cell[1]) / cells_});
      }
}

DiscGrowth::DiscGrowth(const GeneratorOptions& options, const std::vector<double>& radii) {
  const auto n = radii.size();
  double solid = 0;
  for (const double r : radii) solid += particle_size<2>(r);
  const double largest = *std::max_element(radii.begin(), radii.end());
  // Radii that cover all of the box at scale 1.
  const double unit = 1 / std::sqrt(solid);
  scale_ = std::sqrt(start_fraction);
  end_scale_ = std::sqrt(options.growth_end > 0 ? options.growth_end : 1);
  if (2 * largest * unit * end_scale_ > 1) end_scale_ = 1 / (2 * largest * unit);
  cells_ = std::max(1L, static_cast<long>(1 / (2 * largest * unit * end_scale_)));
  members_.resize(static_cast<std::size_t>(cells_ * cells_));
  double mean = 0;
  for (const double r : radii) mean += r * unit / static_cast<double>(n);
  rate_ = options.growth_rate / mean;  // the thermal speed is 1
  for (const double r : radii) discs_.push_back({0, 0, 0, 0, r * unit, 0, {}});
}

void DiscGrowth::place(const Packing& start, std::mt19937_64& engine) {
  const std::size_t n = discs_.size();
  const double side = start.cell[0];
  for (std::size_t p = 0; p < n; ++p) {
    Disc& disc = discs_[p];
    disc.x = start.position[p] / side;
    disc.y = start.position[n + p] / side;
    const double angle = 2 * std::numbers::pi * unit_double(engine);
    disc.u = std::cos(angle);
    disc.v = std::sin(angle);
  }
  rescale();
}

bool DiscGrowth::run() {
  const long block = collisions_per_block * static_cast<long>(discs_.size());
  for (long done = 0; done < most_collisions_per_disc * static_cast<long>(discs_.size());
       done += block) {
    const bool ended = run_block(block);
    const double pressure = reduced_pressure();
    rescale();
    if (ended) return false;
    if (pressure > jammed_pressure) return true;
  }
  return true;
}

double DiscGrowth::free_scale() const {
  double scale = scale_;
  for (std::size_t i = 0; i < discs_.size(); ++i)
    for_neighbours(discs_[i], [&](std::size_t j, const std::array<long, 2>& shift) {
      if (i == j && shift == std::array<long, 2>{}) return;
      const Disc& a = discs_[i];
      const Disc& b = discs_[j];
      const double distance = std::hypot(b.x + static_cast<double>(shift[0]) - a.x,
                                         b.y + static_cast<double>(shift[1]) - a.y);
      scale = std::min(scale, distance / (a.radius + b.radius));
    });
  return scale * (1 - 1e-12);
}

double DiscGrowth::meeting(const Disc& a, const Disc& b, const std::array<long, 2>& shift) const {
  const double late = now_ - b.time;
  const double x = b.x + b.u * late + static_cast<double>(shift[0]) - a.x;
  const double y = b.y + b.v * late + static_cast<double>(shift[1]) - a.y;
  const double u = b.u - a.u;
  const double v = b.v - a.v;
  const double reach = a.radius + b.radius;
  const double size = reach * (scale_ + rate_ * now_);
  const double growth = reach * rate_;
  const double square = u * u + v * v - growth * growth;
  const double half = x * u + y * v - size * growth;
  const double gap = x * x + y * y - size * size;
  if (gap <= 0 && half < 0) return 0;  // touching by rounding, and coming closer
  const double discriminant = half * half - square * gap;
  if (discriminant < 0) return never;
  const double root = std::sqrt(discriminant);
  if (gap > 0) return root > half ? gap / (root - half) : never;
  return square < 0 ? (-half - root) / square : never;
}

void DiscGrowth::predict(std::size_t i) {
  const Disc& disc = discs_[i];
  Event next;
  next.disc = static_cast<int>(i);
  next.turns = disc.turns;
  const auto leaving = [&](double place, double velocity, long cell) {
    const double width = 1 / static_cast<double>(cells_);
    const auto k = static_cast<double>(cell);
    if (velocity > 0) return ((k + 1) * width - place) / velocity;
    return velocity < 0 ? (k * width - place) / velocity : never;
  };
  double time = std::max(
      0.0, std::min(leaving(disc.x, disc.u, disc.cell[0]), leaving(disc.y, disc.v, disc.cell[1])));
  for_neighbours(disc, [&](std::size_t j, const std::array<long, 2>& shift) {
    if (i == j) return;  // no disc grows until it meets its own image
    const double meet = meeting(disc, discs_[j], shift);
    if (meet >= time) return;
    time = meet;
    next.partner = static_cast<int>(j);
    next.shift = shift;
    next.partner_turns = discs_[j].turns;
  });
  next.time = now_ + time;
  events_.push(next);
}

void DiscGrowth::bring_up(Disc& disc) const {
  disc.x += disc.u * (now_ - disc.time);
  disc.y += disc.v * (now_ - disc.time);
  disc.time = now_;
}

// Equal masses; the discs part as fast as they came, seen from the growing surfaces.
void DiscGrowth::collide(Disc& a, Disc& b, const std::array<long, 2>& shift) {
  const double x = b.x + static_cast<double>(shift[0]) - a.x;
  const double y = b.y + static_cast<double>(shift[1]) - a.y;
  const double distance = std::hypot(x, y);
  const double nx = x / distance;
  const double ny = y / distance;
  const double growth = (a.radius + b.radius) * rate_;
  const double kick = growth - ((b.u - a.u) * nx + (b.v - a.v) * ny);
  a.u -= kick * nx;
  a.v -= kick * ny;
  b.u += kick * nx;
  b.v += kick * ny;
  ++a.turns;
  ++b.turns;
  virial_ += kick * distance;
}

// Its place decides, except that it moves at most one cell on, against rounding at the wall.
void DiscGrowth::enter_next_cell(std::size_t i) {
  Disc& disc = discs_[i];
  auto& left = members_[bucket(disc.cell[0], disc.cell[1])];
  left.erase(std::find(left.begin(), left.end(), static_cast<int>(i)));
  const double width = 1 / static_cast<double>(cells_);
  const auto cross = [&](double place, double velocity, long& cell) {
    const double wall = static_cast<double>(velocity > 0 ? cell + 1 : cell) * width;
    const double rest = velocity > 0 ? wall - place : place - wall;
    if (velocity != 0 && rest <= 1e-12 * width) cell += velocity > 0 ? 1 : -1;
  };
  cross(disc.x, disc.u, disc.cell[0]);
  cross(disc.y, disc.v, disc.cell[1]);
  members_[bucket(disc.cell[0], disc.cell[1])].push_back(static_cast<int>(i));
}

bool DiscGrowth::run_block(long collisions) {
  const double end = (end_scale_ - scale_) / rate_;
  virial_ = 0;
  while (collisions > 0) {
    const Event event = events_.top();
    if (event.time >= end) {
      now_ = end;
      return true;
    }
    events_.pop();
    const auto i = static_cast<std::size_t>(event.disc);
    Disc& disc = discs_[i];
    if (event.turns != disc.turns) continue;
    now_ = event.time;
    bring_up(disc);
    if (event.partner < 0) {
      enter_next_cell(i);
      predict(i);
      continue;
    }
    const auto j = static_cast<std::size_t>(event.partner);
    Disc& partner = discs_[j];
    if (event.partner_turns != partner.turns) {
      predict(i);
      continue;
    }
    bring_up(partner);
    collide(disc, partner, event.shift);
    predict(i);
    predict(j);
    --collisions;
  }
  return false;
}

double DiscGrowth::reduced_pressure() const {
  double energy = 0;
  for (const Disc& disc : discs_) energy += 0.5 * (disc.u * disc.u + disc.v * disc.v);
  return now_ > 0 ? 1 + virial_ / (2 * energy * now_) : never;
}

void DiscGrowth::rescale() {
  const auto n = static_cast<double>(discs_.size());
  double u = 0;
  double v = 0;
  for (Disc& disc : discs_) {
    bring_up(disc);
    u += disc.u / n;
    v += disc.v / n;
  }
  double square = 0;
  for (Disc& disc : discs_) {
    disc.u -= u;
    disc.v -= v;
    square += (disc.u * disc.u + disc.v * disc.v) / n;
  }
  const double factor = 1 / std::sqrt(square);
  scale_ += rate_ * now_;
  now_ = 0;
  for (auto& bucket_members : members_) bucket_members.clear();
  events_ = {};
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    Disc& disc = discs_[i];
    disc.u *= factor;
    disc.v *= factor;
    disc.time = 0;
    disc.x -= std::floor(disc.x);
    disc.y -= std::floor(disc.y);
    const auto cell = [&](double place) {
      return std::min(cells_ - 1, static_cast<long>(place * static_cast<double>(cells_)));
    };
    disc.cell = {cell(disc.x), cell(disc.y)};
    members_[bucket(disc.cell[0], disc.cell[1])].push_back(static_cast<int>(i));
  }
  for (std::size_t i = 0; i < discs_.size(); ++i) predict(i);
}

}  // namespace grainlaw::core
