//! Systems behind the C interface, whose right-hand sides are also known by hand or whose costs are kept.

#![expect(unsafe_code, reason = "calls a C interface")]

use std::ffi::{c_int, c_void};
use std::fmt::Write as _;
use std::mem::MaybeUninit;
use std::ptr;

use pc::{
    pc_code, pc_kernel, pc_method, pc_model, pc_solver, pc_solver_options, pc_statistics, pc_status,
    pc_system,
};

/// What [`pc::pc_kernel_rhs`] is to an integrator.
pub type Rhs = unsafe extern "C" fn(f64, *const f64, *mut f64, *mut c_void) -> c_int;

/// A model as text, by name.
#[derive(Clone, Debug)]
pub struct Subject {
    /// What a table calls it.
    pub name: String,
    /// Its text.
    pub text: String,
    /// Where motions of it begin and when they end.
    pub start: Vec<f64>,
    /// When motions of it end.
    pub end: f64,
}

impl Subject {
    fn new(name: impl Into<String>, text: impl Into<String>, start: &[f64], end: f64) -> Subject {
        Subject { name: name.into(), text: text.into(), start: start.to_vec(), end }
    }
}

/// A triaxial top in Poisson's variables: I = (2, 3, 4), mg = 10, r = (1, 2, 3)/10.
pub fn top() -> Subject {
    let text = r#"
        [parameters]
        I1 = 2.0
        I2 = 3.0
        I3 = 4.0
        r1 = 0.1
        r2 = 0.2
        r3 = 0.3
        mg = 10.0
        [coordinates]
        "γ1" = 0.6
        "γ2" = 0.0
        "γ3" = 0.8
        [quasi_velocities]
        "ω1" = 0.1
        "ω2" = 0.2
        "ω3" = 3.0
        [kinematics]
        "γ1" = "γ2*ω3 - γ3*ω2"
        "γ2" = "γ3*ω1 - γ1*ω3"
        "γ3" = "γ1*ω2 - γ2*ω1"
        [algebra]
        name = "so3"
        [lagrangian]
        kinetic = "(I1*ω1^2 + I2*ω2^2 + I3*ω3^2)/2"
        potential = "mg*(r1*γ1 + r2*γ2 + r3*γ3)"
    "#;
    Subject::new("heavy top", text, &[0.6, 0.0, 0.8, 0.1, 0.2, 3.0], 100.0)
}

/// Lagrange's top: I = (1, 1, ½), mg = 1, r = (0, 0, 1).
pub fn symmetric_top() -> Subject {
    let mut text = top().text;
    let numbers = [("I1 = 2.0", "I1 = 1.0"), ("I2 = 3.0", "I2 = 1.0"), ("I3 = 4.0", "I3 = 0.5")];
    let centre = [
        ("r1 = 0.1", "r1 = 0.0"),
        ("r2 = 0.2", "r2 = 0.0"),
        ("r3 = 0.3", "r3 = 1.0"),
        ("mg = 10.0", "mg = 1.0"),
    ];
    for (general, special) in numbers.into_iter().chain(centre) {
        text = text.replacen(general, special, 1);
    }
    Subject::new("symmetric top", text, &[0.6, 0.0, 0.8, 0.1, -0.2, 3.0], 100.0)
}

/// Chaplygin's sleigh, m = J = 1, a = ½.
pub fn sleigh() -> Subject {
    let text = r#"
        [parameters]
        m = 1.0
        J = 1.0
        a = 0.5
        [coordinates]
        x = 0.0
        y = 0.0
        "φ" = 0.0
        [quasi_velocities]
        v = 0.3
        "ω" = 1.0
        u = 0.0
        [kinematics]
        x = "v*cos(φ) - u*sin(φ)"
        y = "v*sin(φ) + u*cos(φ)"
        "φ" = "ω"
        [constraints]
        blade = "u"
        [lagrangian]
        kinetic = "m*(v^2 + (u + a*ω)^2)/2 + J*ω^2/2"
    "#;
    Subject::new("Chaplygin sleigh", text, &[0.0, 0.0, 0.4, 0.3, 1.0], 100.0)
}

/// The sleigh, steered by a stiff spring and a damper.
pub fn stiff_sleigh() -> Subject {
    let text = format!(
        "{}\n{}",
        sleigh().text,
        r#"
        [forces]
        v = "2*sin(2*t) - v/5 - (1 + exp(-4*v^2))/2*tanh(10*v)"
        "ω" = "-1.25e6*(φ - sin(t)/2) - 1.25e6*ω"
    "#
    );
    Subject::new("stiff sleigh", text, &[0.0, 0.0, 0.3, 1.0, 1.0], 5.0)
}

/// A disk that rolls, tilted, by kinematics: m = r = 1, A = ¼, C = ½, g = 10.
pub fn disk() -> Subject {
    let text = r#"
        [parameters]
        m = 1.0
        r = 1.0
        A = 0.25
        C = 0.5
        g = 10.0
        [coordinates]
        X = 0.0
        Y = 0.0
        "ψ" = 0.0
        "θ" = 1.2
        "φ" = 0.0
        [quasi_velocities]
        "ω1" = 0.2
        "ω2" = 0.5
        "ω3" = 4.0
        u = 0.0
        v = 0.0
        [definitions]
        roll = "ω3 - ω2*cot(θ)"
        along = "u - r*roll"
        [kinematics]
        X = "along*cos(ψ) - v*sin(ψ)"
        Y = "along*sin(ψ) + v*cos(ψ)"
        "ψ" = "ω2/sin(θ)"
        "θ" = "ω1"
        "φ" = "roll"
        [constraints]
        rolling = "u"
        sliding = "v"
        [lagrangian]
        kinetic = "m*((u - r*ω3)^2 + (v*cos(θ))^2 + (r*ω1 - v*sin(θ))^2)/2 + A*(ω1^2 + ω2^2)/2 + C*ω3^2/2"
        potential = "m*g*r*sin(θ)"
    "#;
    Subject::new("rolling disk", text, &[0.0, 0.0, 0.0, 1.2, 0.0, 0.2, 0.5, 4.0], 100.0)
}

/// The disk as a body whose angular velocity is defined by velocities.
pub fn disk_by_definitions() -> Subject {
    let text = r#"
        [parameters]
        m = 1.0
        r = 1.0
        g = 10.0
        [coordinates]
        x = 0.0
        y = 0.0
        "ψ" = 0.0
        "θ" = 0.1
        "φ" = 0.0
        [quasi_velocities]
        "ω1" = { is = "θ'", start = 0.2 }
        "ω2" = { is = "ψ'*cos(θ)", start = 0.5 }
        "ω3" = { is = "φ' + ψ'*sin(θ)", start = 4.0 }
        [constraints]
        along = "x' - r*φ'*cos(ψ)"
        across = "y' - r*φ'*sin(ψ)"
        [bodies.disk]
        mass = "m"
        inertia = ["m*r^2/4", "m*r^2/4", "m*r^2/2"]
        angular_velocity = ["ω1", "ω2", "ω3"]
        position = ["x + r*sin(θ)*sin(ψ)", "y - r*sin(θ)*cos(ψ)", "r*cos(θ)"]
        [lagrangian]
        potential = "m*g*r*cos(θ)"
    "#;
    Subject::new("rolling disk, defined", text, &[0.0, 0.0, 0.0, 0.1, 0.0, 0.1, 0.2, 5.0], 100.0)
}

/// A planar pendulum of unit links and masses in angles from the vertical, g = 10, its Lagrangian multiplied out.
pub fn pendulum(links: usize) -> Subject {
    let weight = |i: usize| links - i;
    let pairs = (0..links).flat_map(|i| (0..=i).map(move |j| (i, j)));
    let kinetic: Vec<String> = pairs
        .map(|(i, j)| match i == j {
            true => format!("{}*θ{i}'^2/2", weight(i)),
            false => format!("{}*cos(θ{i} - θ{j})*θ{i}'*θ{j}'", weight(i)),
        })
        .collect();
    let potential: Vec<String> = (0..links).map(|i| format!("-g*{}*cos(θ{i})", weight(i))).collect();
    let text = format!(
        "{}[lagrangian]\nkinetic = \"{}\"\npotential = \"{}\"\n",
        angles(links),
        kinetic.join(" + "),
        potential.join(" + ")
    );
    Subject::new(format!("pendulum of {links} links"), text, &hanging(links), 10.0)
}

/// The same pendulum as masses with positions.
pub fn chain_of_masses(links: usize) -> Subject {
    let mut text = angles(links);
    text.push_str("[gravity]\nacceleration = [0, \"-g\", 0]\n");
    for last in 0..links {
        let sum = |term: &dyn Fn(usize) -> String| (0..=last).map(term).collect::<Vec<_>>().join(" + ");
        let across = sum(&|i| format!("sin(θ{i})"));
        let down = sum(&|i| format!("cos(θ{i})"));
        let _ = writeln!(text, "[bodies.m{last}]\nmass = 1.0\nposition = [\"{across}\", \"-({down})\", 0]");
    }
    Subject::new(format!("{links} masses with positions"), text, &hanging(links), 10.0)
}

/// The parameter and the coordinates of a pendulum.
fn angles(links: usize) -> String {
    let mut text = "[parameters]\ng = 10.0\n[coordinates]\n".to_owned();
    for i in 0..links {
        let _ = writeln!(text, "\"θ{i}\" = 0.2");
    }
    text
}

fn hanging(links: usize) -> Vec<f64> {
    [vec![0.2; links], vec![0.0; links]].concat()
}

/// A code of libpc.
#[derive(Debug)]
pub struct Code(*mut pc_code);

// SAFETY: any number of threads may make systems of one code at the same time.
unsafe impl Sync for Code {}

impl Code {
    /// The code of a text; `None` if libpc refuses it.
    pub fn derived(text: &str) -> Option<Code> {
        let mut model: *mut pc_model = ptr::null_mut();
        let mut code = Code(ptr::null_mut());
        let none = ptr::null_mut();
        // SAFETY: places for handles, a text with its length, and null where the header allows it; the model is ours and
        // not used again.
        let made = unsafe {
            let made =
                pc::pc_model_parse(text.as_ptr().cast(), text.len(), ptr::null(), &raw mut model, none)
                    == pc_status::PC_OK
                    && pc::pc_code_new(model, ptr::null(), &raw mut code.0, none) == pc_status::PC_OK;
            pc::pc_model_free(model);
            made
        };
        made.then_some(code)
    }

    /// The code that was saved in these bytes; `None` if libpc refuses them.
    pub fn loaded(bytes: &[u8]) -> Option<Code> {
        let mut code = Code(ptr::null_mut());
        // SAFETY: bytes with their length, and a place for the handle.
        let status =
            unsafe { pc::pc_code_load(bytes.as_ptr().cast(), bytes.len(), &raw mut code.0, ptr::null_mut()) };
        (status == pc_status::PC_OK).then_some(code)
    }

    /// The code as bytes; `None` if libpc fails.
    pub fn saved(&self) -> Option<Vec<u8>> {
        let (mut data, mut length) = (ptr::null_mut::<c_void>(), 0);
        // SAFETY: a live code, and places for the memory and its length, which is ours to free after it is copied.
        unsafe {
            let status = pc::pc_code_save(self.0, &raw mut data, &raw mut length, ptr::null_mut());
            let saved = (status == pc_status::PC_OK)
                .then(|| std::slice::from_raw_parts(data.cast::<u8>(), length).to_vec());
            pc::pc_bytes_free(data);
            saved
        }
    }

    /// A system of the code with a kernel: what a thread works with.
    pub fn system(&self) -> Option<Handles> {
        let mut handles = Handles { system: ptr::null_mut(), kernel: ptr::null_mut() };
        let none = ptr::null_mut();
        // SAFETY: a live code, and places for handles.
        let made = unsafe {
            pc::pc_system_of_code(self.0, &raw mut handles.system, none) == pc_status::PC_OK
                && pc::pc_kernel_new(handles.system, &raw mut handles.kernel, none) == pc_status::PC_OK
        };
        made.then_some(handles)
    }
}

impl Drop for Code {
    fn drop(&mut self) {
        // SAFETY: ours, null if it was not made, and not used any more.
        unsafe { pc::pc_code_free(self.0) };
    }
}

/// A system of libpc with a kernel.
#[derive(Debug)]
pub struct Handles {
    system: *mut pc_system,
    kernel: *mut pc_kernel,
}

impl Handles {
    /// The system of a text; `None` if libpc refuses it.
    pub fn of(text: &str) -> Option<Handles> {
        let mut model: *mut pc_model = ptr::null_mut();
        let mut handles = Handles { system: ptr::null_mut(), kernel: ptr::null_mut() };
        // SAFETY: places for handles, a text with its length, and null where the header allows it; the model is ours and
        // not used again.
        let made = unsafe {
            let made = pc::pc_model_parse(
                text.as_ptr().cast(),
                text.len(),
                ptr::null(),
                &raw mut model,
                ptr::null_mut(),
            ) == pc_status::PC_OK
                && pc::pc_system_new(model, ptr::null(), &raw mut handles.system, ptr::null_mut())
                    == pc_status::PC_OK
                && pc::pc_kernel_new(handles.system, &raw mut handles.kernel, ptr::null_mut())
                    == pc_status::PC_OK;
            pc::pc_model_free(model);
            made
        };
        made.then_some(handles)
    }

    /// The state at which the motion of the text begins; `None` if libpc fails.
    pub fn start(&self) -> Option<Vec<f64>> {
        // SAFETY: a live system, an array with its length, and a place for the time.
        unsafe {
            let mut y = vec![0.0; pc::pc_system_dim(self.system.as_ref())];
            let mut t = 0.0;
            let status =
                pc::pc_system_start(self.system, &raw mut t, y.as_mut_ptr(), y.len(), ptr::null_mut());
            (status == pc_status::PC_OK).then_some(y)
        }
    }

    /// ẏ by the handle of the system, which checks lengths and that nobody changes the parameters meanwhile. Returns
    /// whether it was computed.
    pub fn by_handle(&self, y: &[f64], dy: &mut [f64]) -> bool {
        // SAFETY: a live system, arrays with their lengths, and null for the error.
        let status = unsafe {
            pc::pc_system_rhs(
                self.system,
                0.0,
                y.as_ptr(),
                y.len(),
                dy.as_mut_ptr(),
                dy.len(),
                ptr::null_mut(),
            )
        };
        status == pc_status::PC_OK
    }

    /// The function and the context that an integrator is given. The context lives as long as this, and is for one
    /// thread.
    pub fn pointers(&self) -> (Rhs, *mut c_void) {
        (pc::pc_kernel_rhs, self.kernel.cast())
    }

    /// A motion from 0 to `end`; the state there and the number of steps, or `None` where libpc fails.
    pub fn integrate(
        &self,
        method: pc_method,
        (relative, absolute): (f64, f64),
        start: &[f64],
        end: f64,
    ) -> Option<(Vec<f64>, u64)> {
        let mut y = start.to_vec();
        let mut solver: *mut pc_solver = ptr::null_mut();
        let mut work = MaybeUninit::<pc_statistics>::zeroed();
        // SAFETY: a live system, structures that libpc fills, an array with its length, and null for errors; the solver
        // is ours.
        let done = unsafe {
            let mut options = pc_solver_options::default();
            pc::pc_solver_options_init(&raw mut options, size_of_val(&options));
            options.method = method as c_int;
            (options.relative_tolerance, options.absolute_tolerance) = (relative, absolute);
            options.max_steps = 10_000_000;
            let (none, len) = (ptr::null_mut(), y.len());
            let done = pc::pc_solver_new(
                self.system,
                &raw const options,
                0.0,
                y.as_ptr(),
                len,
                &raw mut solver,
                none,
            ) == pc_status::PC_OK
                && pc::pc_solver_advance(solver, end, y.as_mut_ptr(), len, none) == pc_status::PC_OK
                && pc::pc_solver_statistics(solver, work.as_mut_ptr(), size_of::<pc_statistics>(), none)
                    == pc_status::PC_OK;
            pc::pc_solver_free(solver);
            done
        };
        // SAFETY: a structure of numbers, all zero before libpc wrote to it.
        done.then(|| (y, unsafe { work.assume_init() }.steps))
    }
}

impl Drop for Handles {
    fn drop(&mut self) {
        // SAFETY: ours, null if they were not made, and not used any more.
        unsafe {
            pc::pc_kernel_free(self.kernel);
            pc::pc_system_free(self.system);
        }
    }
}
