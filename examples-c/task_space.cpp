// The arm of computed_torque.c in C++: its tool follows a circle by computed torque, and then is held by state feedback
// that puts the roots of the linear equations where the linearisation says.
#include <array>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <iostream>
#include <string>

#include "pc.hpp"

namespace {

constexpr std::size_t k = 3, dim = 2 * k; // joints; angles and their rates
constexpr double rate = 5.0;              // both roots of ë + 2·5 ė + 25 e = 0
using vec = std::array<double, 3>;

// As in arm.toml.
const std::string text = R"toml(
[parameters]
g = 9.81
l1 = 0.5
l2 = 0.4
m1 = 4.0
m2 = 2.5
c = 0.2
[gravity]
acceleration = [0, 0, "-g"]
[coordinates]
waist = 0.3
shoulder = -0.6
elbow = 1.3
[bodies.waist]
joint = { kind = "revolute", axis = [0, 0, 1] }
inertia = [0, 0, 0.2]
[bodies.shoulder]
parent = "waist"
joint = { kind = "revolute", axis = [0, 1, 0], at = [0, 0, 0.6] }
mass = "m1"
center = ["l1/2", 0, 0]
inertia = [0.01, "m1*l1^2/12", "m1*l1^2/12"]
[bodies.elbow]
parent = "shoulder"
joint = { kind = "revolute", axis = [0, 1, 0], at = ["l1", 0, 0] }
mass = "m2"
center = ["l2/2", 0, 0]
inertia = [0.005, "m2*l2^2/12", "m2*l2^2/12"]
[points.tool]
body = "elbow"
at = ["l2", 0, 0]
[forces]
"waist'" = "-c*waist'"
"shoulder'" = "-c*shoulder'"
"elbow'" = "-c*elbow'"
[outputs]
height = "tool_z"
rise = "d(tool_z')"
)toml";

vec cross(const vec &a, const vec &b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const vec &a, const vec &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The tool: its position and velocity, and the columns of its J.
struct tool {
    vec x, v;
    std::array<vec, k> columns;

    tool(pc::system &arm, double t, pc::view<const double> y) : x(arm.body_pose(t, y, "tool").position), v{}
    {
        const pc::vector all = arm.body_jacobian(t, y, "tool");
        for (std::size_t s = 0; s < k; s++) {
            for (std::size_t i = 0; i < 3; i++) {
                columns[s][i] = all[i + 6 * s];
                v[i] += columns[s][i] * y[k + s];
            }
        }
    }
    // J⁻¹ a
    vec accelerations(const vec &a) const
    {
        const double det = dot(columns[0], cross(columns[1], columns[2]));
        vec found{};
        for (std::size_t s = 0; s < k; s++) {
            found[s] = dot(a, cross(columns[(s + 1) % k], columns[(s + 2) % k])) / det;
        }
        return found;
    }
};

// Where the tool has to be.
struct wanted {
    vec x, v, a;
};

wanted on_circle(double t)
{
    const double w = 1.5, r = 0.12, c = r * std::cos(w * t), s = r * std::sin(w * t);
    return {{0.65, 0.12 + c, 0.62 + s}, {0.0, -w * s, w * c}, {0.0, -w * w * c, -w * w * s}};
}

// The torque for the accelerations η̇ = J⁻¹ (a − J̇ η): τ = M η̇ + h, which is what inverse dynamics gives.
pc::vector torque(pc::system &arm, const wanted &to, double t, pc::view<const double> y)
{
    const tool now(arm, t, y);
    const pc::vector bias = arm.body_bias(t, y, "tool");
    vec a{};
    for (std::size_t i = 0; i < 3; i++) {
        a[i] = to.a[i] + 2.0 * rate * (to.v[i] - now.v[i]) + rate * rate * (to.x[i] - now.x[i]) - bias[i];
    }
    return arm.inverse_dynamics(t, y, now.accelerations(a));
}

double largest(double a, double b) { return std::fmax(a, std::fabs(b)); }

// τ is M η̇ + h too.
double check_parts(pc::system &arm, pc::view<const double> y)
{
    const vec accelerations{0.3, -0.7, 1.1};
    const pc::vector whole = arm.inverse_dynamics(0.0, y, accelerations), mass = arm.mass_matrix(0.0, y);
    const pc::vector h = arm.inverse_dynamics(0.0, y, vec{});
    double off = 0.0;
    for (std::size_t i = 0; i < k; i++) {
        double sum = h[i];
        for (std::size_t s = 0; s < k; s++) {
            sum += mass[i + k * s] * accelerations[s];
        }
        off = largest(off, whole[i] - sum);
    }
    return off;
}

// Follows the circle; the error is (e_0 + (ė_0 + 5 e_0) t) e^(−5 t). Returns the largest difference from that.
double follow(pc::system &plant, pc::system &arm)
{
    pc::solver_options options;
    options.relative_tolerance = 1e-11;
    pc::solver solver(plant, options);
    std::size_t steps = 0;
    solver.set_monitor([&steps](const pc::step_end &) {
        steps++;
        return true;
    });
    const tool start(arm, 0.0, solver.state());
    const wanted first = on_circle(0.0);
    double worst = 0.0;
    std::cout << "   t    off the path\n" << std::scientific << std::setprecision(6);
    for (int n = 0; n <= 6; n++) {
        const double t = 0.5 * n;
        const tool now(arm, t, n == 0 ? solver.state() : solver.advance(t));
        const wanted to = on_circle(t);
        double off = 0.0;
        for (std::size_t i = 0; i < 3; i++) {
            const double e0 = first.x[i] - start.x[i], de0 = first.v[i] - start.v[i], e = to.x[i] - now.x[i];
            worst = largest(worst, e - (e0 + (de0 + rate * e0) * t) * std::exp(-rate * t));
            off = std::hypot(off, e);
        }
        std::cout << "  " << std::fixed << std::setprecision(1) << t << "   " << std::scientific << std::setprecision(6)
                  << off << '\n';
    }
    std::cout << "in " << steps << " steps\n";
    return worst;
}

// Feedback u = u_0 − G δy with G = B⁺ (A + 5)² in the lower rows, so that δq̈ + 10 δq̇ + 25 δq = 0. Returns how far the arm is off
// after 4 s.
double hold(pc::system &plant, pc::system &arm, const pc::vector &y0)
{
    const pc::vector u0 = arm.gravity(0.0, y0);
    const pc::linear_equations near = plant.linearize(0.0, y0, u0);
    // B = (0, M⁻¹) and the lower rows of A are ∂η̇/∂y, so M (A + …) is the gain.
    const pc::vector mass = arm.mass_matrix(0.0, y0);
    pc::vector gain(k * dim);
    for (std::size_t j = 0; j < dim; j++) {
        for (std::size_t i = 0; i < k; i++) {
            for (std::size_t s = 0; s < k; s++) {
                const double wish = j == s ? rate * rate : j == k + s ? 2.0 * rate : 0.0;
                gain[i + k * j] += mass[i + k * s] * (near.a[k + s + dim * j] + wish);
            }
        }
    }
    // D is C of the velocity of the height times B: the height is accelerated by J_z η̇.
    const std::size_t height = arm.find_observable("height"), rise = arm.find_observable("rise");
    const std::size_t rows = arm.observable_count();
    for (std::size_t s = 0; s < k; s++) {
        double sum = near.d[rise + rows * s];
        for (std::size_t m = 0; m < k; m++) {
            sum -= near.c[height + rows * m] * near.b[k + m + dim * s];
        }
        if (std::fabs(sum) > 1e-12) {
            return 1.0;
        }
    }
    plant.set_force([&](double, pc::view<const double> y, pc::view<double> u) {
        for (std::size_t i = 0; i < k; i++) {
            u[i] = u0[i];
            for (std::size_t j = 0; j < dim; j++) {
                u[i] -= gain[i + k * j] * (y[j] - y0[j]);
            }
        }
    });
    // The closed loop A − B G has the columns wished for.
    const pc::vector closed = plant.jacobian(0.0, y0);
    double off = 0.0;
    for (std::size_t j = 0; j < dim; j++) {
        for (std::size_t s = 0; s < k; s++) {
            off = largest(off, closed[k + s + dim * j] + (j == s ? rate * rate : j == k + s ? 2.0 * rate : 0.0));
        }
    }
    std::cout << "closed loop as wished up to " << off << '\n';
    pc::vector y = y0;
    for (std::size_t i = 0; i < k; i++) {
        y[i] += 0.05;
    }
    const pc::vector last = pc::solver(plant, 0.0, y).advance(4.0);
    for (std::size_t i = 0; i < dim; i++) {
        off = largest(off, last[i] - y0[i]);
    }
    return off;
}

} // namespace

int main()
{
    try {
        const auto model = pc::model::parse(text);
        auto driven = model.clone();
        driven.external_force("waist").external_force("shoulder").external_force("elbow");
        pc::system arm(model), plant(driven);
        plant.set_force([&arm](double t, pc::view<const double> y, pc::view<double> tau) {
            const pc::vector found = torque(arm, on_circle(t), t, y);
            std::copy(found.begin(), found.end(), tau.begin());
        });
        const double parts = check_parts(arm, arm.start().second), worst = follow(plant, arm);
        const double held = hold(plant, arm, arm.start().second);
        std::cout << "tau - (M a + h) is " << parts << ", the path is off the predicted one by " << worst
                  << ", the arm is held up to " << held << '\n';
        return parts < 1e-12 && worst < 1e-8 && held < 1e-5 ? 0 : 1;
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
