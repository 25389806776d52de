//! Compiles `glsl/` to SPIR-V and writes `shaders.rs`: every shader with its words, its bindings by name and kind, and
//! its specialization constants by name. The library embeds them and needs no compiler at run time.

use std::{env, fmt::Write, fs, path::Path, path::PathBuf, process::Command};

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op};
use shaderc::OptimizationLevel;

#[allow(dead_code)]
#[path = "src/shared.rs"]
mod shared;

const SHARED_HEADER: &str = "shared.glsl";
/// Set when building, it leaves shaders as they are written.
const UNOPTIMIZED: &str = "HALFSHADE_UNOPTIMIZED_SHADERS";

fn main() {
    println!("cargo:rerun-if-changed=glsl");
    println!("cargo:rerun-if-changed=src/shared.rs");
    println!("cargo:rerun-if-changed=src/shared/declare.rs");
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets OUT_DIR"));
    clear_shaders(&out);
    let header = shared_header();
    // Validation layers that rewrite shaders break some loops of optimized ones.
    println!("cargo:rerun-if-env-changed={UNOPTIMIZED}");
    let level = match env::var_os(UNOPTIMIZED) {
        Some(_) => OptimizationLevel::Zero,
        None => OptimizationLevel::Performance,
    };
    let mut table = String::from("pub static SHADERS: &[Shader] = &[\n");
    for path in sources(Path::new("glsl")) {
        let words = compile(&path, &header, level);
        // The optimizer strips the names that the recorder binds by.
        let named = compile(&path, &header, OptimizationLevel::Zero);
        let file = path
            .file_name()
            .and_then(|name| name.to_str())
            .expect("a UTF-8 name");
        // The named words are for the test of the layouts.
        for (suffix, words) in [("spv", &words), ("named.spv", &named)] {
            fs::write(
                out.join(format!("{file}.{suffix}")),
                bytemuck::cast_slice::<u32, u8>(words),
            )
            .expect("OUT_DIR is writable");
        }
        let module =
            rspirv::dr::load_words(&named).unwrap_or_else(|error| panic!("{file}: {error}"));
        writeln!(
            table,
            "Shader {{ name: {file:?}, words: words!(\"{file}.spv\"), bindings: &[{}], constants: &[{}] }},",
            bindings(&module, file),
            constants(&module, &used_constants(&words, file), file)
        )
        .expect("writing to a string");
    }
    table.push_str("];\n");
    fs::write(out.join("shaders.rs"), table).expect("OUT_DIR is writable");
    name_shared_library();
    println!("cargo:rustc-env=HALFSHADE_COMMIT={}", commit());
}

/// Removes what earlier builds have compiled: a test reads all that is there, and a shader may be gone.
fn clear_shaders(out: &Path) {
    let files = fs::read_dir(out).into_iter().flatten().flatten();
    let compiled = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "spv");
    for path in files.map(|file| file.path()).filter(compiled) {
        fs::remove_file(path).expect("OUT_DIR is writable");
    }
}

/// The commit that is built, with a "+" when files differ from it; "unknown" outside of a repository.
fn commit() -> String {
    let git = |args: &[&str]| {
        let output = Command::new("git").args(args).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    let Some(commit) = git(&["rev-parse", "--short=12", "HEAD"]) else {
        return "unknown".into();
    };
    // Its log changes with each commit and checkout. Changes of files run this script only if they are shaders.
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]) {
        println!("cargo:rerun-if-changed={log}");
    }
    match git(&["status", "--porcelain", "--untracked-files=no"]) {
        Some(changes) if changes.is_empty() => commit,
        _ => commit + "+",
    }
}

/// Every shader with an entry point below `folder`, in a fixed order.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("glsl is there").flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e != "glsl") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// `src/shared.rs` in GLSL.
fn shared_header() -> String {
    let mut text = String::new();
    for (name, glsl, value) in shared::constants() {
        let suffix = if glsl == "uint" { "u" } else { "" };
        writeln!(text, "const {glsl} {name} = {value}{suffix};").expect("writing to a string");
    }
    for layout in shared::LAYOUTS {
        writeln!(text, "struct {} {{", layout.name).expect("writing to a string");
        for field in layout.fields {
            let array = if field.count > 0 {
                format!("[{}]", field.count)
            } else {
                String::new()
            };
            writeln!(text, "    {} {}{array};", field.glsl, field.name)
                .expect("writing to a string");
        }
        text.push_str("};\n");
    }
    text
}

fn compile(path: &Path, header: &str, level: OptimizationLevel) -> Vec<u32> {
    use shaderc::{CompileOptions, Compiler, EnvVersion, ShaderKind, TargetEnv};
    let kind = match path.extension().and_then(|e| e.to_str()) {
        Some("comp") => ShaderKind::Compute,
        Some("vert") => ShaderKind::Vertex,
        Some("frag") => ShaderKind::Fragment,
        _ => panic!("{}: not a .comp, .vert or .frag", path.display()),
    };
    let mut options = CompileOptions::new().expect("shaderc is there");
    options.set_target_env(TargetEnv::Vulkan, EnvVersion::Vulkan1_3 as u32);
    // 1.6 would state work group sizes by id, which the reflection's reader does not know.
    options.set_target_spirv(shaderc::SpirvVersion::V1_5);
    options.set_optimization_level(level);
    options.set_include_callback(|name, _, _, _| {
        let content = if name == SHARED_HEADER {
            header.to_owned()
        } else {
            fs::read_to_string(Path::new("glsl/lib").join(name))
                .map_err(|e| format!("{name}: {e}"))?
        };
        Ok(shaderc::ResolvedInclude {
            resolved_name: name.to_owned(),
            content,
        })
    });
    let source = fs::read_to_string(path).expect("listed a moment ago");
    let compiled = Compiler::new()
        .expect("shaderc is there")
        .compile_into_spirv(
            &source,
            kind,
            &path.display().to_string(),
            "main",
            Some(&options),
        );
    match compiled {
        Ok(artifact) => artifact.as_binary().to_vec(),
        Err(error) => panic!("{error}"),
    }
}

/// The descriptors of a shader as Rust source: name, binding and kind.
fn bindings(module: &Module, file: &str) -> String {
    let mut text = String::new();
    for decoration in &module.annotations {
        // OpDecorate %variable Binding n
        let [
            Operand::IdRef(variable),
            Operand::Decoration(Decoration::Binding),
            Operand::LiteralBit32(binding),
        ] = decoration.operands[..]
        else {
            continue;
        };
        let (name, kind) = resource(module, variable).unwrap_or_else(|| {
            panic!("{file}: binding {binding} is nothing that the recorder binds")
        });
        write!(
            text,
            "Binding {{ name: {name:?}, binding: {binding}, kind: BindingKind::{kind} }}, "
        )
        .expect("writing to a string");
    }
    text
}

/// The specialization constants of a module: result and id.
fn constant_ids(module: &Module) -> impl Iterator<Item = (u32, u32)> {
    (module.annotations.iter()).filter_map(|decoration| match decoration.operands[..] {
        // OpDecorate %constant SpecId n
        [
            Operand::IdRef(constant),
            Operand::Decoration(Decoration::SpecId),
            Operand::LiteralBit32(id),
        ] => Some((constant, id)),
        _ => None,
    })
}

/// The ids of those constants that the optimizer has left.
fn used_constants(words: &[u32], file: &str) -> Vec<u32> {
    let module = rspirv::dr::load_words(words).unwrap_or_else(|error| panic!("{file}: {error}"));
    constant_ids(&module).map(|(_, id)| id).collect()
}

/// The specialization constants that a shader uses as Rust source: name and id.
fn constants(module: &Module, used: &[u32], file: &str) -> String {
    let mut text = String::new();
    for (constant, id) in constant_ids(module).filter(|(_, id)| used.contains(id)) {
        let name = variable_name(module, constant)
            .unwrap_or_else(|| panic!("{file}: constant {id} has no name"));
        write!(text, "({name:?}, {id}), ").expect("writing to a string");
    }
    text
}

/// Name and kind of a resource variable; an anonymous block goes by the name of its member.
fn resource(module: &Module, variable: u32) -> Option<(&str, &'static str)> {
    let pointer = definition(module, definition(module, variable)?.result_type?)?;
    let ty = pointer
        .operands
        .iter()
        .find_map(|operand| operand.id_ref_any())?;
    match definition(module, ty)? {
        block if block.class.opcode == Op::TypeStruct => {
            Some((member_name(module, ty)?, "StorageBuffer"))
        }
        // Operand 5 of OpTypeImage is 1 for sampled and 2 for storage images.
        image if image.class.opcode == Op::TypeImage => {
            let kind = match image.operands[5] {
                Operand::LiteralBit32(2) => "StorageImage",
                _ => "SampledImage",
            };
            Some((variable_name(module, variable)?, kind))
        }
        _ => None,
    }
}

fn definition(module: &Module, id: u32) -> Option<&Instruction> {
    module
        .types_global_values
        .iter()
        .find(|instruction| instruction.result_id == Some(id))
}

fn variable_name(module: &Module, id: u32) -> Option<&str> {
    module
        .debug_names
        .iter()
        .find_map(|instruction| match &instruction.operands[..] {
            [Operand::IdRef(target), Operand::LiteralString(name)] if *target == id => {
                Some(name.as_str())
            }
            _ => None,
        })
}

/// The name of a block's first member.
fn member_name(module: &Module, id: u32) -> Option<&str> {
    module
        .debug_names
        .iter()
        .find_map(|instruction| match &instruction.operands[..] {
            [
                Operand::IdRef(target),
                Operand::LiteralBit32(0),
                Operand::LiteralString(name),
            ] if *target == id => Some(name.as_str()),
            _ => None,
        })
}

/// Programs that are linked to the C library ask for it by the version of its binary interface; a test compares
/// it with `HS_ABI_VERSION`. cargo-c gives the name itself, from the same number in `Cargo.toml`.
fn name_shared_library() {
    let linux = env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux");
    if linux && env::var_os("CARGO_FEATURE_CAPI").is_some() {
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libhalfshade.so.1");
    }
}
