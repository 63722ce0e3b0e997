// A force computed by the program, in C++: a disk rolls too slowly to stay upright, and a lambda
// steers it, with or without its derivatives.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "pc.hpp"

namespace {

enum { THETA = 3, W1 = 5, W2 = 6, W3 = 7, DIM = 8 }; // of X, Y, ψ, θ, φ, ω1, ω2, ω3
constexpr double half_pi = 1.5707963267948966;
constexpr double a = 0.25, c = 0.5, lean = 70.0 / 1.5, lean_rate = 25.0 / 1.5, turn = 6.0;

// Near upright, (A + mr²) δ'' = mgr δ − (C + mr²) ω3 ω2 and A ω2' = C ω3 δ' + Q for the lean δ = θ
// − π/2. This Q gives ω2' = p δ + q δ' − s ω2, and for ω3 = 1 the three roots −2.
double torque(pc::view<const double> y)
{
    return a * (lean * (y[THETA] - half_pi) + lean_rate * y[W1] - turn * y[W2]) - c * y[W3] * y[W1];
}

pc::system disk(bool steered)
{
    auto model = pc::model::builtin("tilted-disk");
    model.start("θ", half_pi + 0.1).start("ω1", 0.0).start("ω2", 0.0).start("ω3", 1.0);
    if (steered) {
        model.external_force("ω2");
    }
    return pc::system(model);
}

double largest_difference(pc::view<const double> one, pc::view<const double> other)
{
    double largest = 0.0;
    for (std::size_t i = 0; i < one.size(); i++) {
        largest = std::fmax(largest, std::fabs(one[i] - other[i]));
    }
    return largest;
}

} // namespace

int main()
{
    try {
        auto steered = disk(true), left_alone = disk(false);
        bool right = steered.force_names() == std::vector<std::string>{"ω2"} && left_alone.force_count() == 0;
        try {
            steered.rhs(0.0, steered.start().second); // fails: no force function is set yet
            right = false;
        } catch (const pc::error &error) {
            right = right && error.status() == PC_EVALUATION;
        }

        std::atomic<unsigned long> calls{0};
        steered.set_force([&calls](double, pc::view<const double> y, pc::view<double> q) {
            calls++;
            q[0] = torque(y);
        });
        pc::solver_options options;
        options.relative_tolerance = 1e-11;
        std::array<double, DIM> y{}, fallen{};
        pc::solver solver(steered, options);
        right = right && solver.advance(20.0, y) == PC_OK && calls > 500;
        pc::solver(left_alone, options).advance(0.8, fallen);
        std::cout << "left alone it leans by " << fallen[THETA] - half_pi << " after 0.8; steered by "
                  << y[THETA] - half_pi << " after 20\n";
        // ω3 tends to 0.978, where the slowest root is −1.09: e^(−21) of the lean remains.
        right = right && std::fabs(y[THETA] - half_pi) < 1e-8 && fallen[THETA] - half_pi > 0.4;

        // Its derivatives, compared with difference quotients of step 1e-8.
        const pc::vector there{0.0, 0.0, 0.3, 1.6, 0.2, 0.1, -0.2, 1.0};
        const pc::vector quotients = steered.jacobian(0.0, there);
        auto exact = disk(true);
        exact.set_force([](double, pc::view<const double> y, pc::view<double> q) { q[0] = torque(y); },
                        [](double, pc::view<const double> y, pc::view<double> dq) {
                            std::fill(dq.begin(), dq.end(), 0.0);
                            dq[THETA] = a * lean;
                            dq[W1] = a * lean_rate - c * y[W3];
                            dq[W2] = -a * turn;
                            dq[W3] = -c * y[W1];
                        });
        const double off = largest_difference(exact.jacobian(0.0, there), quotients);
        right = right && off > 0.0 && off < 1e-5;

        // Copies on several threads call the same function at the same time, and give the same
        // rates.
        pc::vector rates[2];
        std::vector<std::thread> threads;
        for (pc::vector &rate : rates) {
            threads.emplace_back([&rate, &there, copy = steered.clone()]() mutable { rate = copy.rhs(0.0, there); });
        }
        for (std::thread &thread : threads) {
            thread.join();
        }
        right = right && rates[0] == rates[1] && rates[0] == steered.rhs(0.0, there);
        return right ? 0 : 1;
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
