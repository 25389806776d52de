//! What passes can bind, by name.

use std::collections::BTreeMap;

use super::host::{HostBuffer, HostImage};
use super::memory::{Buffer, Image};
use crate::error::{Error, Result};

/// A buffer or an image, the library's own or lent by a host.
pub enum Resource {
    Buffer(Buffer),
    Image(Image),
    HostBuffer(HostBuffer),
    HostImage(HostImage),
}

/// Everything that passes can bind, under the name that the shaders know it by.
#[derive(Default)]
pub struct Resources(BTreeMap<&'static str, Resource>);

impl Resources {
    pub fn add_buffer(&mut self, name: &'static str, buffer: Buffer) {
        self.0.insert(name, Resource::Buffer(buffer));
    }

    pub fn add_image(&mut self, name: &'static str, image: Image) {
        self.0.insert(name, Resource::Image(image));
    }

    pub fn add_host_buffer(&mut self, name: &'static str, buffer: HostBuffer) {
        self.0.insert(name, Resource::HostBuffer(buffer));
    }

    pub fn add_host_image(&mut self, name: &'static str, image: HostImage) {
        self.0.insert(name, Resource::HostImage(image));
    }

    pub fn get(&self, name: &str) -> Option<&Resource> {
        self.0.get(name)
    }

    pub fn host_images(&self) -> impl Iterator<Item = &HostImage> {
        self.0.values().filter_map(|resource| match resource {
            Resource::HostImage(image) => Some(image),
            _ => None,
        })
    }

    /// The named buffer. Errors: there is none.
    pub fn buffer(&self, name: &str) -> Result<&Buffer> {
        match self.get(name) {
            Some(Resource::Buffer(buffer)) => Ok(buffer),
            _ => Err(Error::Unsupported(format!("there is no buffer {name}"))),
        }
    }

    /// The named image. Errors: there is none.
    pub fn image(&self, name: &str) -> Result<&Image> {
        match self.get(name) {
            Some(Resource::Image(image)) => Ok(image),
            _ => Err(Error::Unsupported(format!("there is no image {name}"))),
        }
    }

    /// Errors: one of these is no buffer.
    pub fn check_buffers<'n>(
        &self,
        names: impl IntoIterator<Item = &'n &'static str>,
    ) -> Result<()> {
        let mut names = names.into_iter();
        names.try_for_each(|name| self.buffer(name).map(drop))
    }

    pub fn images(&self) -> impl Iterator<Item = &Image> {
        self.0.values().filter_map(|resource| match resource {
            Resource::Image(image) => Some(image),
            _ => None,
        })
    }
}
