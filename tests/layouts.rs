//! Every struct that host and shaders share has one layout: offsets, array strides and array lengths
//! of the host's structs against what the compiled shaders say. Resources and specialization constants
//! have one number each in all shaders.

use std::collections::{BTreeMap, BTreeSet};

use halfshade::shared::{LAYOUTS, Layout};
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op};

/// A struct member as a compiled shader describes it.
#[derive(Debug, Default)]
struct Member {
    name: String,
    /// [byte] None: the struct is not in memory that the host sees.
    offset: Option<u32>,
    /// Id of its type.
    ty: u32,
}

/// A compiled shader, not optimised, with the names.
struct Reflection {
    file: String,
    module: Module,
}

impl Reflection {
    /// All shaders that `build.rs` compiled.
    fn all() -> Vec<Self> {
        let folder = std::fs::read_dir(env!("OUT_DIR")).expect("the build's folder");
        let mut files: Vec<_> = folder.flatten().map(|entry| entry.path()).collect();
        files.sort();
        let named = files
            .into_iter()
            .filter(|path| path.to_string_lossy().ends_with(".named.spv"));
        named
            .map(|path| Self {
                file: path
                    .file_name()
                    .unwrap_or_default()
                    .to_string_lossy()
                    .into_owned(),
                module: rspirv::dr::load_bytes(std::fs::read(&path).expect("a shader"))
                    .unwrap_or_else(|error| panic!("{}: {error}", path.display())),
            })
            .collect()
    }

    fn definition(&self, id: u32) -> &Instruction {
        let found = self
            .module
            .types_global_values
            .iter()
            .find(|i| i.result_id == Some(id));
        found.unwrap_or_else(|| panic!("{}: %{id} is not defined", self.file))
    }

    /// Members of a struct type.
    fn members(&self, id: u32) -> Vec<Member> {
        let mut structs = self.structs().into_iter();
        let found = structs.find_map(|(known, _, members)| (known == id).then_some(members));
        found.unwrap_or_else(|| panic!("{}: %{id} is no struct", self.file))
    }

    /// Id, name and members of every struct type.
    fn structs(&self) -> Vec<(u32, String, Vec<Member>)> {
        let mut names = BTreeMap::new();
        let mut members: BTreeMap<u32, Vec<Member>> = BTreeMap::new();
        for ty in &self.module.types_global_values {
            if let (Op::TypeStruct, Some(id)) = (ty.class.opcode, ty.result_id) {
                let types = ty
                    .operands
                    .iter()
                    .filter_map(|operand| operand.id_ref_any());
                let member = |ty| Member {
                    ty,
                    ..Member::default()
                };
                members.insert(id, types.map(member).collect());
            }
        }
        for note in self
            .module
            .debug_names
            .iter()
            .chain(&self.module.annotations)
        {
            match &note.operands[..] {
                [Operand::IdRef(id), Operand::LiteralString(name)] => {
                    names.insert(*id, name.clone());
                }
                [
                    Operand::IdRef(id),
                    Operand::LiteralBit32(at),
                    Operand::LiteralString(name),
                ] => {
                    members.get_mut(id).expect("a struct")[*at as usize].name = name.clone();
                }
                [
                    Operand::IdRef(id),
                    Operand::LiteralBit32(at),
                    Operand::Decoration(Decoration::Offset),
                    Operand::LiteralBit32(offset),
                ] => members.get_mut(id).expect("a struct")[*at as usize].offset = Some(*offset),
                _ => {}
            }
        }
        members
            .into_iter()
            .map(|(id, members)| (id, names.get(&id).cloned().unwrap_or_default(), members))
            .collect()
    }

    fn literal(&self, constant: u32) -> u32 {
        match self.definition(constant).operands[..] {
            [Operand::LiteralBit32(value)] => value,
            ref other => panic!("{}: {other:?} is no 32-bit constant", self.file),
        }
    }

    fn array_stride(&self, id: u32) -> u32 {
        let stride = |note: &Instruction| match note.operands[..] {
            [
                Operand::IdRef(target),
                Operand::Decoration(Decoration::ArrayStride),
                Operand::LiteralBit32(stride),
            ] if target == id => Some(stride),
            _ => None,
        };
        let found = self.module.annotations.iter().find_map(stride);
        found.unwrap_or_else(|| panic!("{}: array %{id} has no stride", self.file))
    }

    /// A type by its GLSL name, and the number of elements (0: not an array) and their stride.
    fn describe(&self, ty: u32) -> (String, usize, usize) {
        let definition = self.definition(ty);
        let operand = |at: usize| match definition.operands[at] {
            Operand::IdRef(id) | Operand::LiteralBit32(id) => id,
            ref other => panic!("{}: unexpected operand {other:?}", self.file),
        };
        match definition.class.opcode {
            Op::TypeFloat => ("float".into(), 0, 0),
            Op::TypeInt => (if operand(1) == 0 { "uint" } else { "int" }.into(), 0, 0),
            Op::TypeVector => {
                let prefix = if self.describe(operand(0)).0 == "uint" {
                    "u"
                } else {
                    ""
                };
                (format!("{prefix}vec{}", operand(1)), 0, 0)
            }
            Op::TypeArray => {
                let count = self.literal(operand(1)) as usize;
                (
                    self.describe(operand(0)).0,
                    count,
                    self.array_stride(ty) as usize,
                )
            }
            other => (format!("{other:?}"), 0, 0),
        }
    }

    fn name(&self, id: u32) -> String {
        let named = |note: &Instruction| match &note.operands[..] {
            [Operand::IdRef(target), Operand::LiteralString(name)] if *target == id => {
                Some(name.clone())
            }
            _ => None,
        };
        let found = self.module.debug_names.iter().find_map(named);
        found.unwrap_or_else(|| panic!("{}: %{id} has no name", self.file))
    }

    /// Id and number of everything that is decorated so.
    fn numbered(&self, with: Decoration) -> Vec<(u32, u32)> {
        let number = |note: &Instruction| match note.operands[..] {
            [
                Operand::IdRef(id),
                Operand::Decoration(decoration),
                Operand::LiteralBit32(number),
            ] if decoration == with => Some((id, number)),
            _ => None,
        };
        self.module.annotations.iter().filter_map(number).collect()
    }

    /// Binding and name of every resource.
    fn resources(&self) -> Vec<(u32, String)> {
        let name = |variable: u32| {
            let operand = |id: u32, at: usize| match self.definition(id).operands[at] {
                Operand::IdRef(id) => id,
                ref other => panic!("{}: unexpected operand {other:?}", self.file),
            };
            let pointer = self.definition(variable).result_type.expect("a variable");
            let ty = operand(pointer, 1);
            match self.definition(ty).class.opcode {
                // An anonymous block goes by the name of its member.
                Op::TypeStruct => self.members(ty)[0].name.clone(),
                _ => self.name(variable),
            }
        };
        let bindings = self.numbered(Decoration::Binding).into_iter();
        bindings.map(|(id, number)| (number, name(id))).collect()
    }

    /// Number and name of every specialization constant.
    fn constants(&self) -> Vec<(u32, String)> {
        let ids = self.numbered(Decoration::SpecId).into_iter();
        ids.map(|(id, number)| (number, self.name(id))).collect()
    }

    /// [byte] Stride of every runtime array of a struct called `name`.
    fn strides_of(&self, name: &str) -> Vec<u32> {
        let ids: BTreeSet<u32> = self
            .module
            .debug_names
            .iter()
            .filter_map(|note| match &note.operands[..] {
                [Operand::IdRef(id), Operand::LiteralString(known)] if known == name => Some(*id),
                _ => None,
            })
            .collect();
        let arrays = self.module.types_global_values.iter().filter(|ty| {
            ty.class.opcode == Op::TypeRuntimeArray
                && ty.operands[0]
                    .id_ref_any()
                    .is_some_and(|element| ids.contains(&element))
        });
        arrays
            .map(|ty| self.array_stride(ty.result_id.expect("a type")))
            .collect()
    }
}

/// Compares a struct in memory with the host's; panics where they differ.
fn compare(shader: &Reflection, layout: &Layout, members: &[Member]) {
    let place = format!("{} in {}", layout.name, shader.file);
    let names: Vec<&str> = members.iter().map(|member| member.name.as_str()).collect();
    let fields: Vec<&str> = layout.fields.iter().map(|field| field.name).collect();
    assert_eq!(names, fields, "{place}");
    for (member, field) in members.iter().zip(layout.fields) {
        let place = format!("{}.{} in {}", layout.name, field.name, shader.file);
        assert_eq!(member.offset, Some(field.offset as u32), "{place}");
        let (glsl, count, stride) = shader.describe(member.ty);
        assert_eq!((glsl.as_str(), count), (field.glsl, field.count), "{place}");
        if count > 0 {
            // Host arrays are tightly packed.
            let next = layout
                .fields
                .iter()
                .map(|f| f.offset)
                .filter(|&at| at > field.offset)
                .min();
            let end = next.unwrap_or(layout.size);
            assert_eq!(field.offset + count * stride, end, "{place}");
        }
    }
}

#[test]
fn shared_structs_have_one_layout() {
    let shaders = Reflection::all();
    assert!(shaders.len() >= 14, "only {} shaders", shaders.len());
    let mut found = BTreeSet::new();
    for shader in &shaders {
        for (_, name, members) in shader.structs() {
            let Some(layout) = LAYOUTS.iter().find(|layout| layout.name == name) else {
                continue;
            };
            // A struct that lives in registers only has no offsets.
            if members.iter().any(|member| member.offset.is_some()) {
                compare(shader, layout, &members);
                found.insert(layout.name);
            }
        }
    }
    let missing: Vec<_> = LAYOUTS
        .iter()
        .map(|l| l.name)
        .filter(|name| !found.contains(name))
        .collect();
    assert!(missing.is_empty(), "in no shader's memory: {missing:?}");
}

#[test]
fn arrays_of_shared_structs_have_the_hosts_stride() {
    let mut found = BTreeSet::new();
    for shader in Reflection::all() {
        for layout in LAYOUTS {
            for stride in shader.strides_of(layout.name) {
                assert_eq!(
                    stride as usize, layout.size,
                    "{} in {}",
                    layout.name, shader.file
                );
                found.insert(layout.name);
            }
        }
    }
    for name in [
        "Surface", "Light", "View", "Fit", "Lists", "Kernel", "Packet",
    ] {
        assert!(found.contains(name), "no shader has an array of {name}");
    }
}

/// Compares numbers and names over all shaders; panics where a number has two names or a name two numbers.
fn one_number_each(kind: &str, of: impl Fn(&Reflection) -> Vec<(u32, String)>) {
    let mut names = BTreeMap::new();
    let mut numbers = BTreeMap::new();
    for shader in Reflection::all() {
        for (number, name) in of(&shader) {
            let place = format!("{kind} {number}, {name}, in {}", shader.file);
            let known = names.entry(number).or_insert_with(|| name.clone());
            assert_eq!(*known, name, "{place}");
            let known = numbers.entry(name).or_insert(number);
            assert_eq!(*known, number, "{place}");
        }
    }
    assert!(names.len() > 20, "only {} found: {kind}", names.len());
}

#[test]
fn a_resource_has_one_binding_in_all_shaders() {
    one_number_each("binding", Reflection::resources);
}

#[test]
fn a_specialization_constant_has_one_id_in_all_shaders() {
    one_number_each("constant", Reflection::constants);
}
