#pragma once

#include "dem/specimen/specimen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

/// Flat joints as one would write them down at first: a struct a grain, a struct a joint, loops and branches, one
/// number at a time. The measure of the engine's speed, and a second opinion on its results: it shares no code with it.
namespace feldspar::plain
{
struct Grain
{
  double x, y, vx, vy, spin, mass, inertia, fx, fy, couple;
};

struct Joint
{
  std::size_t one, two;
  double k_n, k_s, radius, half_difference, rest, nx, ny, opening, theta, slip;
  std::array<double, 4> tau, sigma_b, c_b;
  std::array<bool, 4> bonded;
};

struct Body
{
  std::vector<Grain> grains;
  std::vector<Joint> joints;
  double mu, tan_phi, alpha, thickness;
  std::size_t n_broken = 0;

  /// The same specimen; joints must have four segments.
  Body(const Specimen<2>& specimen, const double damping)
    : mu(specimen.joints.friction)
    , tan_phi(specimen.joints.friction_slope)
    , alpha(damping)
    , thickness(specimen.thickness)
  {
    const auto& g = specimen.grains;
    for (std::size_t i = 0; i < g.size(); ++i)
      grains.push_back({g.position[0][i], g.position[1][i], g.velocity[0][i], g.velocity[1][i], g.spin[0][i], g.mass[i],
                        g.moment_of_inertia[i], 0.0, 0.0, 0.0});
    const auto& j = specimen.joints;
    for (std::size_t k = 0; k < j.size(); ++k)
      {
        Joint joint{j.grain_1[k],
                    j.grain_2[k],
                    j.normal_stiffness[k],
                    j.shear_stiffness[k],
                    j.half_length[k],
                    j.half_radius_difference[k],
                    j.rest_distance[k],
                    j.normal[0][k],
                    j.normal[1][k],
                    j.opening[k],
                    j.rotation[0][k],
                    j.slip[0][k],
                    {},
                    {},
                    {},
                    {}};
        for (unsigned int s = 0; s < 4; ++s)
          {
            joint.tau[s] = j.shear_stress[0][j.segment(s, k)];
            joint.sigma_b[s] = j.tensile_strength[j.segment(s, k)];
            joint.c_b[s] = j.cohesion[j.segment(s, k)];
            joint.bonded[s] = j.bonded[j.segment(s, k)] > 0.5;
          }
        joints.push_back(joint);
      }
  }

  void step(const double dt)
  {
    move(dt);
    sweep(dt);
  }

  void move(const double dt)
  {
    const auto kick = [&](double& velocity, const double force, const double inertia) {
      const double drag = velocity > 0.0 ? -alpha * std::abs(force) : velocity < 0.0 ? alpha * std::abs(force) : 0.0;
      velocity += dt * (force + drag) / inertia;
    };
    for (Grain& g : grains)
      {
        kick(g.vx, g.fx, g.mass);
        kick(g.vy, g.fy, g.mass);
        kick(g.spin, g.couple, g.inertia);
        g.x += dt * g.vx;
        g.y += dt * g.vy;
      }
  }

  void sweep(const double dt)
  {
    for (Grain& g : grains)
      g.fx = g.fy = g.couple = 0.0;
    for (Joint& j : joints)
      {
        Grain& one = grains[j.one];
        Grain& two = grains[j.two];
        const double dx = two.x - one.x;
        const double dy = two.y - one.y;
        const double d = std::sqrt(dx * dx + dy * dy);
        const double nx = dx / d;
        const double ny = dy / d;
        const double mean_d = 0.5 * (j.rest + j.opening + d);
        const double turned = std::asin(j.nx * ny - j.ny * nx);
        const double slip = mean_d * turned - (0.5 * mean_d + j.half_difference) * one.spin * dt -
                            (0.5 * mean_d - j.half_difference) * two.spin * dt;
        const double opening = d - j.rest;
        const double theta = j.theta + (two.spin - one.spin) * dt;
        const double l = 2.0 * j.radius / 4.0;
        const double area = l * thickness;
        double normal_force = 0.0;
        double shear_force = 0.0;
        double moment = 0.0;
        for (int s = 0; s < 4; ++s)
          {
            const double rho = j.radius * (3.0 - 2.0 * s) / 4.0;
            const double gap = opening - theta * rho;
            double force = -j.k_n * area * gap;
            double segment_moment = -j.k_n * thickness * theta * l * l * l / 12.0;
            bool broke = false;
            double trial = 0.0;
            if (j.bonded[s])
              {
                const double sigma = j.k_n * gap;
                trial = j.tau[s] - j.k_s * slip;
                if (sigma > j.sigma_b[s] || std::abs(trial) > std::max(0.0, j.c_b[s] - sigma * tan_phi))
                  {
                    broke = true;
                    j.bonded[s] = false;
                    ++n_broken;
                  }
              }
            if (!j.bonded[s])
              {
                const double low = gap - 0.5 * std::abs(theta) * l;
                const double high = gap + 0.5 * std::abs(theta) * l;
                if (low >= 0.0)
                  force = segment_moment = 0.0;
                else if (high > 0.0)
                  {
                    const double h = l * -low / (high - low);
                    force = 0.5 * j.k_n * thickness * h * -low;
                    segment_moment = (theta < 0.0 ? 1.0 : -1.0) * force * (0.5 * l - h / 3.0);
                  }
                if (broke)
                  trial = 0.0;
                else
                  {
                    const double gap_before = j.opening - j.theta * rho;
                    double share = gap < 0.0 ? 1.0 : 0.0;
                    if ((gap < 0.0) != (gap_before < 0.0))
                      share = (gap < 0.0 ? gap : -gap_before) / (gap - gap_before);
                    if (gap < 0.0 && gap_before >= 0.0)
                      share = gap / (gap - gap_before);
                    trial = j.tau[s] - j.k_s * share * slip;
                    const double limit = mu * std::max(0.0, force / area);
                    trial = std::clamp(trial, -limit, limit);
                  }
              }
            j.tau[s] = trial;
            normal_force += force;
            shear_force += trial * area;
            moment += segment_moment - rho * force;
          }
        j.nx = nx;
        j.ny = ny;
        j.opening = opening;
        j.theta = theta;
        j.slip += slip;
        const double fx = normal_force * nx - shear_force * ny;
        const double fy = normal_force * ny + shear_force * nx;
        one.fx -= fx;
        one.fy -= fy;
        two.fx += fx;
        two.fy += fy;
        one.couple -= moment + (0.5 * d + j.half_difference) * shear_force;
        two.couple += moment - (0.5 * d - j.half_difference) * shear_force;
      }
  }
};
} // namespace feldspar::plain
