//! What callers hold: numbers in the shape of pointers. They are looked up and never followed, so a handle that was
//! destroyed, made up or of another kind is found out.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, RwLock};

use super::call_result::{CallResult, Fault, quietly};
use super::types::HS_INTERNAL;

/// All living objects of a kind.
pub struct Registry<H, T> {
    /// What callers call it.
    name: &'static str,
    objects: RwLock<BTreeMap<usize, Arc<T>>>,
    handle: std::marker::PhantomData<fn(*mut H)>,
}

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

    pub fn add(&self, object: T) -> CallResult<*mut H> {
        // Multiples of 16, as addresses of objects would be.
        let key = NEXT.fetch_add(16, Ordering::Relaxed);
        let mut objects = self.objects.write().map_err(|_| self.broken())?;
        objects.insert(key, Arc::new(object));
        Ok(std::ptr::without_provenance_mut(key))
    }

    pub fn get(&self, handle: *const H) -> Option<Arc<T>> {
        self.objects.read().ok()?.get(&handle.addr()).cloned()
    }

    pub fn find(&self, handle: *const H) -> CallResult<Arc<T>> {
        self.get(handle).ok_or_else(|| {
            Fault::invalid(match handle.is_null() {
                true => format!("the {} is NULL", self.name),
                false => format!("the {} is none, or was destroyed before", self.name),
            })
        })
    }

    /// Lets go of an object; it ends when nothing needs it any more. NULL is nothing.
    pub fn remove(&self, handle: *mut H) {
        quietly(|| {
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
