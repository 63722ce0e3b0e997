//! Which packages hold the tools, for each package manager.

use crate::tools::{Machine, Tool};

/// The package managers for which we know the names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PackageManager {
    /// Debian, Ubuntu.
    Apt,
    /// Fedora.
    Dnf,
    /// Arch Linux.
    Pacman,
    /// openSUSE.
    Zypper,
    /// macOS: libclang, make and the compiler are in Apple's command line tools.
    Brew,
}

impl PackageManager {
    const ALL: [(&str, PackageManager); 5] = [
        ("apt-get", PackageManager::Apt),
        ("dnf", PackageManager::Dnf),
        ("pacman", PackageManager::Pacman),
        ("zypper", PackageManager::Zypper),
        ("brew", PackageManager::Brew),
    ];

    /// The package manager found on this machine.
    pub(crate) fn of(machine: &Machine) -> Option<PackageManager> {
        Self::ALL.into_iter().find(|(program, _)| machine.has_program(program)).map(|(_, manager)| manager)
    }

    /// The packages that hold these tools.
    pub(crate) fn packages(self, tools: &[Tool]) -> Vec<&'static str> {
        tools.iter().flat_map(|&tool| self.packages_of(tool)).copied().collect()
    }

    /// The package with the run-time of the sanitizers for a clang of this version, where it is one of its own.
    pub(crate) fn sanitizers(self, version: &str) -> Option<String> {
        let major = version.trim().split('.').next().filter(|major| major.parse::<u32>().is_ok())?;
        match self {
            PackageManager::Apt => Some(format!("libclang-rt-{major}-dev")),
            PackageManager::Dnf | PackageManager::Pacman => Some("compiler-rt".to_owned()),
            PackageManager::Zypper | PackageManager::Brew => None,
        }
    }

    /// The command line, or lines, that installs these tools.
    pub(crate) fn install_line(self, tools: &[Tool]) -> String {
        let packages = self.packages(tools).join(" ");
        match self {
            PackageManager::Apt => format!("sudo apt-get install --no-install-recommends {packages}"),
            PackageManager::Dnf => format!("sudo dnf install {packages}"),
            PackageManager::Pacman => format!("sudo pacman -S --needed {packages}"),
            PackageManager::Zypper => format!("sudo zypper install {packages}"),
            PackageManager::Brew => {
                let mut lines = Vec::new();
                if tools.iter().any(|&tool| self.packages_of(tool).is_empty()) {
                    lines.push("xcode-select --install".to_owned());
                }
                if !packages.is_empty() {
                    lines.push(format!("brew install {packages}"));
                }
                lines.join("\n  ")
            }
        }
    }

    fn packages_of(self, tool: Tool) -> &'static [&'static str] {
        match (self, tool) {
            (PackageManager::Brew, Tool::CCompiler | Tool::Make | Tool::Libclang | Tool::CppCompiler) => &[],
            (PackageManager::Apt, Tool::Python) => &["python3", "python3-venv"],
            (PackageManager::Pacman | PackageManager::Brew, Tool::Python) => &["python"],
            (PackageManager::Dnf | PackageManager::Zypper, Tool::Python) => &["python3"],
            (_, Tool::Cmake) => &["cmake"],
            (_, Tool::Make) => &["make"],
            (PackageManager::Apt, Tool::CCompiler) => &["gcc", "libc6-dev"],
            (PackageManager::Apt, Tool::CppCompiler) => &["g++"],
            (PackageManager::Pacman, Tool::CCompiler | Tool::CppCompiler) => &["gcc"],
            (PackageManager::Dnf | PackageManager::Zypper, Tool::CppCompiler) => &["gcc-c++"],
            (PackageManager::Dnf | PackageManager::Zypper, Tool::CCompiler) => &["gcc", "glibc-devel"],
            (PackageManager::Apt, Tool::Libclang) => &["libclang-dev"],
            (PackageManager::Pacman, Tool::Libclang) => &["clang"],
            (PackageManager::Dnf | PackageManager::Zypper, Tool::Libclang) => &["clang-devel"],
        }
    }
}

/// What to tell the user where we do not install by ourselves.
pub(crate) fn remedy(manager: Option<PackageManager>, tools: &[Tool]) -> String {
    match manager {
        Some(manager) => format!("install with\n  {}", manager.install_line(tools)),
        None => "install these with your system's packages; LIBCLANG_PATH may name the directory of libclang"
            .into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_package_manager_has_its_names() {
        for (manager, line) in [
            (
                PackageManager::Apt,
                "sudo apt-get install --no-install-recommends gcc libc6-dev cmake make libclang-dev",
            ),
            (PackageManager::Dnf, "sudo dnf install gcc glibc-devel cmake make clang-devel"),
            (PackageManager::Pacman, "sudo pacman -S --needed gcc cmake make clang"),
            (PackageManager::Zypper, "sudo zypper install gcc glibc-devel cmake make clang-devel"),
            (PackageManager::Brew, "xcode-select --install\n  brew install cmake"),
        ] {
            assert_eq!(manager.install_line(&Tool::OF_BUILD), line);
        }
    }

    #[test]
    fn only_what_is_missing_is_installed() {
        assert_eq!(PackageManager::Apt.packages(&[Tool::Libclang]), ["libclang-dev"]);
        assert_eq!(PackageManager::Apt.packages(&[Tool::CppCompiler]), ["g++"]);
        assert_eq!(PackageManager::Dnf.packages(&[Tool::CppCompiler]), ["gcc-c++"]);
        assert_eq!(PackageManager::Brew.install_line(&[Tool::Cmake]), "brew install cmake");
        assert_eq!(PackageManager::Brew.install_line(&[Tool::Libclang]), "xcode-select --install");
    }

    #[test]
    fn sanitizers_are_those_of_the_compiler() {
        let of = |version| PackageManager::Apt.sanitizers(version);
        assert_eq!(of("14.0.6\n").as_deref(), Some("libclang-rt-14-dev"));
        assert_eq!(of("19").as_deref(), Some("libclang-rt-19-dev"));
        assert_eq!(of("unknown"), None);
        assert_eq!(PackageManager::Dnf.sanitizers("20.1.8").as_deref(), Some("compiler-rt"));
        assert_eq!(PackageManager::Brew.sanitizers("17"), None);
    }

    #[test]
    fn the_remedy_is_a_command_to_copy() {
        assert_eq!(
            remedy(Some(PackageManager::Pacman), &[Tool::Cmake, Tool::Libclang]),
            "install with\n  sudo pacman -S --needed cmake clang"
        );
        assert!(remedy(None, &[Tool::Cmake]).contains("LIBCLANG_PATH"));
    }
}
