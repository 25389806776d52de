//! What callers hold: numbers in the shape of pointers. They are looked up and never followed, so a handle that was
//! destroyed, made up or of another kind is found out.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, RwLock};

use super::context::Context;
use super::outcome::{Fault, Outcome, Scope};
use super::renderer::Rendering;
use super::types::*;
use super::vulkan_effect::Frames;
use super::vulkan_types::hs_vk_effect;
use crate::scene::Scene;
use crate::shot::Shot;

/// An object that lives in a context.
pub struct Held<T> {
    // Before the context, which it needs while it goes.
    value: Mutex<T>,
    pub context: Arc<Context>,
}

impl<T> Held<T> {
    pub fn new(context: &Arc<Context>, value: T) -> Self {
        Self {
            value: Mutex::new(value),
            context: context.clone(),
        }
    }

    /// Runs `work` on the object, one call at a time.
    pub fn with<R>(&self, work: impl FnOnce(&mut T) -> Outcome<R>) -> Outcome<R> {
        let mut value = self.value.lock().map_err(|_| {
            Fault::new(
                HS_INTERNAL,
                "an earlier call on this object ended in an error of the library; destroy it",
            )
        })?;
        work(&mut value)
    }
}

/// All living objects of a kind.
pub struct Registry<H, T> {
    /// What callers call it.
    name: &'static str,
    objects: RwLock<BTreeMap<usize, Arc<T>>>,
    handle: std::marker::PhantomData<fn(*mut H)>,
}

pub static CONTEXTS: Registry<hs_context, Context> = Registry::new("context");
pub static SCENES: Registry<hs_scene, Held<Arc<Scene>>> = Registry::new("scene");
pub static SHOTS: Registry<hs_shot, Held<Shot>> = Registry::new("shot");
pub static RENDERERS: Registry<hs_renderer, Held<Rendering>> = Registry::new("renderer");

pub static EFFECTS: Registry<hs_vk_effect, Held<Frames>> = Registry::new("effect");

/// The next handle of any kind: none is ever given twice.
static NEXT: AtomicUsize = AtomicUsize::new(16);

impl<H, T> Registry<H, T> {
    pub const fn new(name: &'static str) -> Self {
        Self {
            name,
            objects: RwLock::new(BTreeMap::new()),
            handle: std::marker::PhantomData,
        }
    }

    pub fn add(&self, object: T) -> Outcome<*mut H> {
        // Multiples of 16, as addresses of objects would be.
        let key = NEXT.fetch_add(16, Ordering::Relaxed);
        let mut objects = self.objects.write().map_err(|_| self.broken())?;
        objects.insert(key, Arc::new(object));
        Ok(std::ptr::without_provenance_mut(key))
    }

    pub fn get(&self, handle: *const H) -> Option<Arc<T>> {
        self.objects.read().ok()?.get(&handle.addr()).cloned()
    }

    pub fn find(&self, handle: *const H) -> Outcome<Arc<T>> {
        self.get(handle).ok_or_else(|| {
            Fault::invalid(match handle.is_null() {
                true => format!("the {} is NULL", self.name),
                false => format!("the {0} is not a {0}, or was destroyed before", self.name),
            })
        })
    }

    /// Lets go of an object; it ends when nothing needs it any more. NULL is nothing.
    pub fn remove(&self, handle: *mut H) {
        super::outcome::quietly(|| {
            // The lock is given back before the object goes.
            let removed = match self.objects.write() {
                Ok(mut objects) => objects.remove(&handle.addr()),
                Err(_) => None,
            };
            drop(removed);
        });
    }

    fn broken(&self) -> Fault {
        Fault::new(HS_INTERNAL, format!("the list of {}s is broken", self.name))
    }
}

impl<H, T> Registry<H, Held<T>> {
    /// An object whose context the call then belongs to.
    pub fn enter(&self, scope: &mut Scope, handle: *const H) -> Outcome<Arc<Held<T>>> {
        let held = self.find(handle)?;
        scope.enter(&held.context)?;
        Ok(held)
    }
}

impl Registry<hs_context, Context> {
    pub fn enter(&self, scope: &mut Scope, handle: *const hs_context) -> Outcome<Arc<Context>> {
        let context = self.find(handle)?;
        scope.enter(&context)?;
        Ok(context)
    }
}
