# Nephroid with its denoiser.
#   docker build -t nephroid .
#   docker run --rm -v "$PWD:/scenes" nephroid render first.toml --denoise

FROM rust:1-slim-bookworm AS build
WORKDIR /src
COPY . .
RUN cargo build --release --locked --package nephroid-cli

# Open Image Denoise, from the wheel that carries it.
FROM python:3.12-slim-bookworm AS oidn
RUN pip install --no-cache-dir --no-deps --target /wheel pyoidn

FROM debian:bookworm-slim
COPY --from=build /src/target/release/nephroid /usr/local/bin/nephroid
COPY --from=oidn /wheel/pyoidn/oidn/lib /opt/oidn/lib
ENV OIDN_DIR=/opt/oidn
USER 1000:1000
WORKDIR /scenes
ENTRYPOINT ["nephroid"]
