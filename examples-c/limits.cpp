// Ending long work from another thread or by a time limit; parts of equations that depend on time.
#include <array>
#include <cstdint>
#include <chrono>
#include <cmath>
#include <iostream>
#include <string>
#include <thread>

#include "pc.hpp"

namespace {

// A pendulum of mass m whose rod of length 1 hangs from a point that moves by a sin ωt.
pc::model shaken()
{
    pc::model model("Shaken pendulum");
    model.parameter("m", 2.0).parameter("a", 0.1).parameter("w", 3.0).coordinate("q", 0.5);
    model.kinetic("m*(q'^2 + 2*a*w*cos(w*t)*cos(q)*q' + a^2*w^2*cos(w*t)^2)/2").potential("-9.81*m*cos(q)");
    model.differentiate().check();
    return model;
}

// m q'' = −9.81 m sin q + m a ω² sin ωt cos q
bool parts(const pc::model &model)
{
    pc::system system(model);
    const double t = 0.4, m = 2.0, a = 0.1, w = 3.0;
    const std::array<double, 2> y{0.7, -0.3};
    const double along = a * w * w * std::cos(y[0]), turned = std::sin(w * t);
    const double r = m * (along * turned - 9.81 * std::sin(y[0]));
    const double rounding = 1e-14; // about ten operations with numbers up to 20
    const auto near = [rounding](double found, double expected) { return std::fabs(found - expected) < rounding; };

    const pc::vector v{3.0}, by_parameters = system.parameter_jacobian(t, y);
    bool right = near(system.right_hand_side(t, y)[0], r) && near(system.solve_mass_matrix(t, y, v)[0], v[0] / m);
    right = right && near(system.solve_mass_matrix(t, y, system.right_hand_side(t, y))[0], system.rhs(t, y)[1]);
    right = right && near(system.time_derivative(t, y)[1], along * w * std::cos(w * t));
    const std::size_t of_a = system.find_parameter("a");
    return right && near(by_parameters[2 * of_a + 1], along * turned / a);
}

// Whether a call ends with PC_LIMIT and a message that contains these words.
template <class Call> bool limited(Call call, const std::string &words)
{
    try {
        call();
    } catch (const pc::error &error) {
        return error.status() == PC_LIMIT && std::string(error.what()).find(words) != std::string::npos;
    }
    return false;
}

} // namespace

int main()
{
    try {
        const pc::model model = shaken();
        bool right = parts(model);

        // An integration of days, ended by another thread; it stays at the time that it reached.
        const pc::cancel cancel;
        pc::limits limits;
        limits.by = &cancel;
        pc::system system(model, PC_POINCARE, limits);
        pc::solver_options options;
        options.max_steps = UINT64_MAX;
        pc::solver solver(system, options);
        std::thread elsewhere([&cancel] {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            cancel.request();
        });
        right = limited([&] { solver.advance(1e12); }, "cancelled, after reaching t = ") && right;
        elsewhere.join();
        right = right && cancel.is_requested() && solver.time() > 0.0 && std::isfinite(solver.state()[0]);
        right = limited([&] { pc::system(model, PC_POINCARE, limits); }, "cancelled") && right;

        // A tenth of a second for each call; the next call continues.
        limits.by = nullptr;
        limits.time = 0.1;
        pc::system timed(model, PC_POINCARE, limits);
        pc::solver hurried(timed, options);
        right = limited([&] { hurried.advance(1e12); }, "than the limit of 0.1 s") && right;
        const double reached = hurried.time();
        hurried.advance(reached + 1.0);
        right = right && hurried.time() == reached + 1.0;

        // A memory limit.
        limits.time = 0.0;
        limits.memory = 1000;
        right = limited([&] { pc::system(model, PC_POINCARE, limits); }, "more memory would be needed") && right;
        std::cout << (right ? "ended where it should" : "wrong") << '\n';
        return right ? 0 : 1;
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
