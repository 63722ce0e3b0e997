// Every call that builds a model, and the text that they write.
#include <iostream>
#include <string>

#include "pc.hpp"

namespace {

// A model that makes no sense as a whole.
pc::model everything()
{
    pc::model model("All of it");
    model.description("what").reference("whence").parameter("m", 1.0).definition("twice", "2*m");
    model.coordinate("x", 0.0).quasi_velocity("v", "x'", 0.5).quasi_velocity("w", 0.25).kinematics("x", "v");
    model.algebra("so3").bracket("v", "w", "2*v").constraint("rail", "x - 1").constraint_kind("rail", "holonomic");
    model.lagrangian("v^2").kinetic("v^3").potential("x").dissipation("v^4").force("v", "m");
    model.body("bob", "m", {"1", "2", "3"}).body_force("bob", {"4", "5", "6"}).body_torque("bob", {"7", "8", "9"});
    model.body_angular_velocity("bob", {"v", "w", "0"}).body_inertia("bob", {"1", "1", "m"});
    model.body_rotation("bob", {"1", "2", "3", "4", "5", "6", "7", "8", "9"});
    model.integral("half", "v/2").output("place", "x");
    model.action("a*x").action_constant("a", 2.0);
    model.event("hit", "x", PC_FALLING, true).event_reset("hit", "v", "-v").event("pass", "x - 2");
    model.start("x", 3.0).start("v", "m/3").start_time(1.0).end_time(2.0).samples(11).tolerances(1e-6, 1e-8);
    return model.method("bdf").form("canonical").clone();
}

const std::string text = R"([model]
"name" = "All of it"
"description" = "what"
"reference" = "whence"

[parameters]
"m" = 1.0

[definitions]
"twice" = "2*m"

[coordinates]
"x" = 3.0

[quasi_velocities]
"v"."is" = "x'"
"v"."start" = "m/3"
"w" = 0.25

[kinematics]
"x" = "v"

[algebra]
"name" = "so3"

[algebra.brackets]
"v,w" = "2*v"

[constraints]
"rail"."expr" = "x - 1"
"rail"."kind" = "holonomic"

[lagrangian]
"lagrangian" = "v^2"
"kinetic" = "v^3"
"potential" = "x"
"dissipation" = "v^4"

[bodies]
"bob"."mass" = "m"
"bob"."position" = ["1", "2", "3"]
"bob"."force" = ["4", "5", "6"]
"bob"."torque" = ["7", "8", "9"]
"bob"."angular_velocity" = ["v", "w", "0"]
"bob"."inertia" = ["1", "1", "m"]
"bob"."rotation" = ["1", "2", "3", "4", "5", "6", "7", "8", "9"]

[forces]
"v" = "m"

[integrals]
"half" = "v/2"

[outputs]
"place" = "x"

[hamilton_jacobi]
"action" = "a*x"
"constants"."a" = 2.0

[events]
"hit"."when" = "x"
"hit"."direction" = "falling"
"hit"."terminal" = true
"hit"."reset"."v" = "-v"
"pass"."when" = "x - 2"
"pass"."direction" = "both"
"pass"."terminal" = false

[simulation]
"t_start" = 1.0
"t_end" = 2.0
"samples" = 11
"rtol" = 1e-6
"atol" = 1e-8
"method" = "bdf"
"form" = "canonical"
)";

} // namespace

int main()
{
    try {
        const pc::model model = everything();
        std::cout << (model.text() == text ? "all calls are in the text\n" : model.text());
        return model.text() == text ? 0 : 1;
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
