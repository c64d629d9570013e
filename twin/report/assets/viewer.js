// The 3-D view of one attempt: the cell's shapes moved by recorded poses, what was perceived, the
// scanner's points and the gripper's path, in step with the load at the wrist.
(function () {
  "use strict";

  const page = (window.tubetwin = window.tubetwin || {});
  const kStep_m = 1e-4; // Positions are in 0.1 mm, as AttemptScene() says.
  const kBox = 0, kSphere = 1, kCapsule = 2; // 3: cylinder.
  const kPlaySpeed = 4; // Simulated seconds per second.

  function capsule(radius, half) {
    const points = [];
    const arc = 6;
    for (let i = 0; i <= arc; ++i) {
      const a = (i / arc - 1) * (Math.PI / 2);
      points.push(new THREE.Vector2(radius * Math.cos(a), -half + radius * Math.sin(a)));
    }
    for (let i = 0; i <= arc; ++i) {
      const a = (i / arc) * (Math.PI / 2);
      points.push(new THREE.Vector2(radius * Math.cos(a), half + radius * Math.sin(a)));
    }
    return new THREE.LatheBufferGeometry(points, 16).rotateX(Math.PI / 2);
  }

  function shapeOf(geom) {
    const s = geom.size;
    if (geom.shape === kBox) return new THREE.BoxBufferGeometry(2 * s[0], 2 * s[1], 2 * s[2]);
    if (geom.shape === kSphere) return new THREE.SphereBufferGeometry(s[0], 24, 16);
    if (geom.shape === kCapsule) return capsule(s[0], s[1]);
    return new THREE.CylinderBufferGeometry(s[0], s[0], 2 * s[1], 28).rotateX(Math.PI / 2);
  }

  function place(object, pose) {
    object.position.set(pose[0], pose[1], pose[2]);
    object.quaternion.set(pose[4], pose[5], pose[6], pose[3]);
  }

  function linePoints(base64) {
    const numbers = page.shorts(base64);
    const out = [];
    for (let i = 0; i + 2 < numbers.length; i += 3) {
      out.push(new THREE.Vector3(numbers[i], numbers[i + 1], numbers[i + 2]).multiplyScalar(kStep_m));
    }
    return out;
  }

  // A body's poses at a time in samples, interpolated between its keys.
  function Track(base64) {
    const numbers = page.shorts(base64);
    const kNumbers = 8;
    const count = numbers.length / kNumbers;
    const a = new THREE.Quaternion(), b = new THREE.Quaternion();
    const read = function (key, position, quaternion) {
      const n = numbers, i = key * kNumbers;
      position.set(n[i + 1], n[i + 2], n[i + 3]).multiplyScalar(kStep_m);
      quaternion.set(n[i + 5], n[i + 6], n[i + 7], n[i + 4]).normalize();
    };
    const next = new THREE.Vector3();
    this.apply = function (object, sample) {
      let low = 0, high = count - 1;
      while (low < high) {
        const middle = (low + high + 1) >> 1;
        if (numbers[middle * kNumbers] <= sample) low = middle;
        else high = middle - 1;
      }
      read(low, object.position, a);
      object.quaternion.copy(a);
      if (low + 1 >= count) return;
      const from = numbers[low * kNumbers], to = numbers[(low + 1) * kNumbers];
      const share = Math.min(1, Math.max(0, (sample - from) / (to - from)));
      read(low + 1, next, b);
      object.position.lerp(next, share);
      object.quaternion.slerp(b, share);
    };
  }

  const kTubeColours = ["#c9a26b", "#8fa9c4", "#a7bf8e", "#c795a6", "#b7a6d1", "#7fb5ad", "#d0b98a", "#a5a29b"];

  function Attempt(data, index) {
    const scene = data.attempts[index].scene;
    const root = new THREE.Group();
    const groups = {};
    for (const name of ["arm", "tubes", "seen", "cloud", "path", "rest"]) {
      groups[name] = new THREE.Group();
      root.add(groups[name]);
    }
    const tracks = scene.bodies.map((keys) => new Track(keys));
    const moved = [];
    for (const geom of data.cells[scene.cell]) {
      const body = new THREE.Group();
      const colour = geom.tube
        ? kTubeColours[geom.tube % kTubeColours.length]
        : "rgb(" + geom.rgb.join(",") + ")";
      const mesh = new THREE.Mesh(shapeOf(geom), new THREE.MeshStandardMaterial({ color: colour, roughness: 0.75 }));
      place(mesh, geom.pose);
      body.add(mesh);
      const still = scene.bodies[geom.body].length <= 24; // One key: 16 bytes.
      tracks[geom.body].apply(body, 0);
      groups[geom.tube ? "tubes" : still ? "rest" : "arm"].add(body);
      if (!still) moved.push([tracks[geom.body], body]);
    }
    const looks = scene.looks.map(function (look) {
      const seen = new THREE.Group();
      for (const tube of look.tubes) {
        const curve = new THREE.CatmullRomCurve3(linePoints(tube.line));
        const name = ["free", "weak", "strong"][tube.class];
        const mesh = new THREE.Mesh(
          new THREE.TubeBufferGeometry(curve, 60, tube.target ? 0.006 : 0.003, 8),
          new THREE.MeshBasicMaterial({ color: page.colour(name), depthTest: false, transparent: true, opacity: 0.9 })
        );
        mesh.renderOrder = 2;
        seen.add(mesh);
      }
      const geometry = new THREE.BufferGeometry();
      const numbers = page.shorts(look.cloud);
      const positions = new Float32Array(numbers.length);
      for (let i = 0; i < numbers.length; ++i) positions[i] = numbers[i] * kStep_m;
      geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
      const points = new THREE.Points(geometry, new THREE.PointsMaterial({ color: page.colour("cloud"), size: 2, sizeAttenuation: false }));
      groups.seen.add(seen);
      groups.cloud.add(points);
      return { sample: look.sample, seen: seen, points: points };
    });
    const path = linePoints(scene.path);
    const pathLine = new THREE.Line(
      new THREE.BufferGeometry().setFromPoints(path.length > 0 ? path : [new THREE.Vector3()]),
      new THREE.LineBasicMaterial({ color: page.colour("a1") })
    );
    groups.path.add(pathLine);

    this.root = root;
    this.scene = scene;
    this.show = function (name, visible) {
      groups[name].visible = visible;
    };
    this.set = function (sample) {
      for (const [track, body] of moved) track.apply(body, sample);
      let last = -1;
      looks.forEach(function (look, i) {
        if (look.sample <= sample) last = i;
      });
      looks.forEach(function (look, i) {
        look.seen.visible = look.points.visible = i === last;
      });
      pathLine.geometry.setDrawRange(0, Math.floor(sample) + 1);
    };
    this.caption = function (sample) {
      let text = "";
      for (const [from, said] of scene.captions) if (from <= sample) text = said;
      return text;
    };
    this.dispose = function () {
      root.traverse(function (object) {
        if (object.geometry) object.geometry.dispose();
        if (object.material) object.material.dispose();
      });
    };
  }

  // The load at the wrist with a line at the time that is shown.
  function ForceChart(canvas) {
    let chart = null, shown = null, now_s = 0;
    const cursor = {
      id: "cursor",
      afterDatasetsDraw: function (of) {
        const x = of.scales.x.getPixelForValue(now_s);
        const area = of.chartArea, context = of.ctx;
        context.save();
        context.strokeStyle = page.colour("bad");
        context.beginPath();
        context.moveTo(x, area.top);
        context.lineTo(x, area.bottom);
        context.stroke();
        context.restore();
      },
    };
    this.load = function (scene) {
      shown = scene;
      if (chart) chart.destroy();
      const force = page.shorts(scene.force);
      const points = [];
      for (let i = 0; i < force.length; ++i) points.push({ x: i * scene.sample_s, y: force[i] / 100 });
      const options = page.chartOptions("seconds", "load, N");
      options.plugins.legend = { display: false };
      options.scales.x.type = "linear";
      options.scales.x.max = (scene.samples - 1) * scene.sample_s;
      chart = new Chart(canvas, {
        type: "line",
        data: { datasets: [{ label: "load, N", data: points, borderColor: page.colour("a0"), borderWidth: 1.5, pointRadius: 0, pointHitRadius: 6 }] },
        options: options,
        plugins: [cursor],
      });
    };
    this.set = function (seconds) {
      now_s = seconds;
      if (chart) chart.draw();
    };
    this.retheme = function () {
      if (shown) this.load(shown);
    };
  }

  page.startViewer = function (data) {
    const byId = (id) => document.getElementById(id);
    const stage = byId("stage");
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("webgl", { antialias: true, alpha: true, preserveDrawingBuffer: true });
    const chart = new ForceChart(byId("force-chart"));
    const has3d = context !== null;
    let renderer, camera, controls, world;
    if (has3d) {
      byId("stage-note").hidden = true;
      stage.appendChild(canvas);
      renderer = new THREE.WebGLRenderer({ canvas: canvas, context: context, alpha: true });
      renderer.setPixelRatio(Math.min(2, devicePixelRatio));
      renderer.setClearColor(0x000000, 0);
      THREE.Object3D.DefaultUp.set(0, 0, 1);
      world = new THREE.Scene();
      world.add(new THREE.HemisphereLight(0xffffff, 0x9aa0a8, 1.15));
      const sun = new THREE.DirectionalLight(0xffffff, 0.85);
      sun.position.set(1.5, -2, 3);
      world.add(sun);
      camera = new THREE.PerspectiveCamera(36, 1, 0.02, 30);
      camera.up.set(0, 0, 1);
      controls = new THREE.OrbitControls(camera, canvas);
      controls.enableKeys = false; // Arrow keys step through time.
      controls.screenSpacePanning = true;
    }

    let attempt = null, sample = 0, playing = false, before = 0;
    const render = function () {
      if (has3d && attempt) renderer.render(world, camera);
    };
    const set = function (value) {
      sample = Math.min(Math.max(0, value), attempt.scene.samples - 1);
      if (has3d) attempt.set(sample);
      const seconds = sample * attempt.scene.sample_s;
      byId("time").value = String(sample);
      byId("clock").textContent = seconds.toFixed(1) + " of " + ((attempt.scene.samples - 1) * attempt.scene.sample_s).toFixed(1) + " s";
      byId("caption").textContent = attempt.caption(sample);
      chart.set(seconds);
      render();
    };
    const checks = ["arm", "tubes", "seen", "cloud", "path"];
    const look = function () {
      const pose = attempt.scene.bin.pose;
      controls.target.set(pose[0] - 0.08, pose[1] - 0.06, pose[2] + 0.1);
      camera.position.set(pose[0] + 0.95, pose[1] - 1.1, pose[2] + 0.95);
      if (stage.clientWidth < 600) camera.position.sub(controls.target).multiplyScalar(1.45).add(controls.target);
      controls.update();
    };
    const load = function (index) {
      if (attempt && has3d) {
        world.remove(attempt.root);
        attempt.dispose();
      }
      const first = attempt === null;
      attempt = has3d ? new Attempt(data, index) : { scene: data.attempts[index].scene, caption: () => "" };
      if (has3d) {
        world.add(attempt.root);
        for (const name of checks) attempt.show(name, byId("show-" + name).checked);
        if (first) look();
      }
      byId("time").max = String(attempt.scene.samples - 1);
      chart.load(attempt.scene);
      // Begin where the pipeline has looked and is about to move: the pile as it was understood.
      const looks = attempt.scene.looks;
      set(looks.length > 0 ? Math.min(looks[0].sample + 8, attempt.scene.samples - 1) : 0);
    };
    const resize = function () {
      if (!has3d) return;
      const width = stage.clientWidth, height = stage.clientHeight;
      if (width === 0 || height === 0) return;
      renderer.setSize(width, height);
      camera.aspect = width / height;
      camera.updateProjectionMatrix();
      render();
    };

    const tick = function (now) {
      if (!playing) return;
      set(sample + ((now - before) / 1000) * (kPlaySpeed / attempt.scene.sample_s));
      before = now;
      if (sample >= attempt.scene.samples - 1) play(false);
      else requestAnimationFrame(tick);
    };
    const play = function (on) {
      playing = on;
      byId("play").textContent = on ? "Pause" : "Play";
      if (!on) return;
      if (sample >= attempt.scene.samples - 1) set(0);
      before = performance.now();
      requestAnimationFrame(tick);
    };

    byId("play").addEventListener("click", () => play(!playing));
    byId("time").addEventListener("input", function () {
      play(false);
      set(Number(byId("time").value));
    });
    stage.addEventListener("keydown", function (event) {
      const step = { ArrowLeft: -1, ArrowRight: 1, PageUp: -20, PageDown: 20 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      play(false);
      set(Math.round(sample) + step);
    });
    byId("attempt").addEventListener("change", () => load(Number(byId("attempt").value)));
    for (const link of document.querySelectorAll("a[data-scene]")) {
      link.addEventListener("click", function () {
        byId("attempt").value = link.dataset.scene;
        load(Number(link.dataset.scene));
      });
    }
    if (has3d) {
      controls.addEventListener("change", render);
      for (const name of checks) {
        byId("show-" + name).addEventListener("change", function () {
          attempt.show(name, byId("show-" + name).checked);
          render();
        });
      }
    }
    page.onTheme.push(function () {
      chart.retheme();
      if (has3d) load(Number(byId("attempt").value));
    });
    resize();
    load(0);
    resize();
    addEventListener("resize", resize);
    page.viewer = { set: set, load: load, has3d: has3d };
  };
})();
