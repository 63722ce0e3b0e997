// A rolling disk, whose constraints are kept in an integrator of the program: everything is written
// to existing arrays. Then the same by steps of the library.
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "pc.hpp"

namespace {

using state = std::array<double, 8>; // X, Y, φ, θ and their rates
constexpr double m = 2.0, radius = 0.5, heading = 0.2, roll = 3.0, turn = 0.5;

// The disk rolls in a circle: X' = R θ' cos φ, Y' = R θ' sin φ, with θ' = 3 and φ' = 1/2.
double off_circle(double t, pc::view<const double> y)
{
    const double phi = heading + turn * t, r = radius * roll / turn;
    const double x = 1.0 + r * (std::sin(phi) - std::sin(heading)), z = -1.0 - r * (std::cos(phi) - std::cos(heading));
    return std::fabs(y[0] - x) + std::fabs(y[1] - z) + std::fabs(y[2] - phi) + std::fabs(y[3] - roll * t);
}

// A Runge–Kutta step of order four, then projection to the constraints.
void step(pc::system &of, double t, double h, state &y)
{
    const double part[] = {0.0, 0.5, 0.5, 1.0}, weight[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    state k{}, at, sum = y;
    for (int stage = 0; stage < 4; stage++) {
        for (std::size_t i = 0; i < y.size(); i++) {
            at[i] = y[i] + part[stage] * h * k[i];
        }
        of.rhs(t + part[stage] * h, at, k);
        for (std::size_t i = 0; i < y.size(); i++) {
            sum[i] += weight[stage] * h * k[i];
        }
    }
    y = sum;
    of.project(t + h, y);
}

double largest(pc::view<const double> numbers)
{
    double largest = 0.0;
    for (const double number : numbers) {
        largest = std::fmax(largest, std::fabs(number));
    }
    return largest;
}

} // namespace

int main()
{
    try {
        auto model = pc::model::builtin("vertical-disk");
        pc::system disk(model.observe_reactions().keep("energy"));
        bool right = disk.constraint_names() == std::vector<std::string>{"along", "across"};
        right = right && disk.reaction_names() == std::vector<std::string>{"λ_along", "λ_across"};
        right = right && disk.conserved_count() == 3 && disk.observable_names()[2] == "energy";

        state y;
        const auto [t, start] = disk.start();
        std::copy(start.begin(), start.end(), y.begin());
        for (int i = 0; i < 400; i++) {
            step(disk, 0.01 * i, 0.01, y);
        }
        const double own = off_circle(4.0, y);
        right = right && t == 0.0 && own < 4e-8; // 400 h⁵
        right = right && largest(disk.constraint_residuals(4.0, y)) < 1e-13;

        // The reactions of the constraints along X and Y are m X'' and m Y''.
        double reactions[2], observables[5];
        disk.reactions(4.0, y, reactions);
        disk.observe(4.0, y, observables);
        right = right && std::fabs(reactions[0] + m * radius * roll * turn * std::sin(y[2])) < 1e-9;
        right = right && std::fabs(reactions[1] - m * radius * roll * turn * std::cos(y[2])) < 1e-9;
        right = right && observables[3] == reactions[0] && std::fabs(observables[2] - disk.energy(0.0, start)) < 1e-12;

        // A state off the constraints is projected onto them.
        y[4] += 0.1;
        right = right && largest(disk.constraint_residuals(4.0, y)) > 0.05;
        disk.project(4.0, y);
        right = right && largest(disk.constraint_residuals(4.0, y)) < 1e-13;

        // Steps of the method, and interpolation between them.
        pc::solver_options options;
        options.method = PC_BDF;
        options.relative_tolerance = 1e-9;
        options.absolute_tolerances = pc::vector(7, 1e-11);
        try {
            pc::solver seven(disk, options);
            right = false;
        } catch (const pc::error &error) {
            right = right && error.status() == PC_INVALID_ARGUMENT;
        }
        options.absolute_tolerances.push_back(1e-11);
        pc::solver solver(disk, 0.0, start, options);
        state between;
        double worst = 0.0;
        while (solver.time() < 4.0) {
            solver.step(4.0, y);
            const pc_statistics work = solver.statistics();
            solver.interpolate(work.step_time - 0.5 * work.last_step, 0, between);
            worst = std::fmax(worst, off_circle(work.step_time, y));
            worst = std::fmax(worst, off_circle(work.step_time - 0.5 * work.last_step, between));
        }
        solver.state(between);
        // Errors of 1e-9 in the rates, amplified by four units of time and the radius of the
        // circle.
        right = right && worst < 1e-6 && between == y && solver.statistics().steps > 10;
        std::cout << "off the circle by " << own << " and " << worst << '\n';
        return right ? 0 : 1;
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
