"""A package of the C library, built from the sources above this directory."""

import os

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.files import copy


class Pc(ConanFile):
    name = "pc"
    version = "0.1.0"
    license = "MIT OR Apache-2.0"
    homepage = "https://example.org/pc"
    description = "Poincaré-Chetaev equations of mechanical systems"
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False]}
    default_options = {"shared": True}

    def configure(self):
        # The library has a C interface and comes from another compiler.
        self.settings.rm_safe("compiler.cppstd")
        self.settings.rm_safe("compiler.libcxx")

    def validate(self):
        if self.settings.os != "Linux":
            raise ConanInvalidConfiguration("`cargo xtask install` is for Linux")

    @property
    def _sources(self):
        return os.path.join(self.recipe_folder, "..", "..")

    def export_sources(self):
        left_out = ("target/*", ".git/*", "*/__pycache__/*")
        copy(self, "*", self._sources, self.export_sources_folder, excludes=left_out)

    def build(self):
        self.run("cargo build --release --locked --package pc-capi --lib", cwd=self.source_folder)

    def package(self):
        self.run(
            f'cargo run --locked --package xtask -- install --prefix "{self.package_folder}"', cwd=self.source_folder
        )
        copy(self, "LICENSE-*", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "pc")
        self.cpp_info.set_property("cmake_target_name", "pc::pc")
        self.cpp_info.set_property("pkg_config_name", "libpc")
        self.cpp_info.libs = ["pc"] if self.options.shared else [":libpc.a"]
        if not self.options.shared:
            self.cpp_info.system_libs = ["m", "pthread", "dl", "rt", "util"]
