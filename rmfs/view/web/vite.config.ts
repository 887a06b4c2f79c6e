import { createHash } from "node:crypto";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { defineConfig, type Plugin } from "vite";

const OUT = process.env.RMFS_VIEWER_OUT ?? "../static";

/** What the build is made from: these and everything below src. */
const SOURCES = [
  "index.html",
  "package-lock.json",
  "package.json",
  "tsconfig.json",
  "vite.config.ts",
];

/** Writes the hash of the sources beside the build, so that a test tells whether they agree. */
function recorded(): Plugin {
  return {
    name: "recorded",
    closeBundle() {
      const below = readdirSync("src", { recursive: true, withFileTypes: true });
      const files = below
        .filter((entry) => entry.isFile())
        .map((entry) => join(entry.parentPath, entry.name).replaceAll("\\", "/"));
      const hash = createHash("sha256");
      for (const name of [...SOURCES, ...files].sort()) {
        hash.update(`${name}\n`).update(readFileSync(name)).update("\n");
      }
      const text = JSON.stringify({ sources_sha256: hash.digest("hex") }, null, 2);
      writeFileSync(join(OUT, "build.json"), `${text}\n`);
    },
  };
}

/**
 * Puts the licences of the packages in the page at the head of its script and style, so that
 * exported pages carry them too, and into a file of their own.
 */
function licensed(): Plugin {
  return {
    name: "licensed",
    closeBundle() {
      const packages = Object.keys(JSON.parse(readFileSync("package.json", "utf8")).dependencies);
      const notices = packages.sort().map((name) => {
        const about = JSON.parse(readFileSync(`node_modules/${name}/package.json`, "utf8"));
        const text = readFileSync(`node_modules/${name}/LICENSE`, "utf8").trim();
        return `${name} ${about.version} (${about.license})\n\n${text.replaceAll("\r\n", "\n")}\n`;
      });
      const head = "The page of the viewer of rmfs contains these packages:\n\n";
      const all = head + notices.join("\n");
      writeFileSync(join(OUT, "notices.txt"), all);
      for (const name of ["app.js", "app.css"]) {
        const file = join(OUT, name);
        writeFileSync(file, `/*!\n${all}*/\n${readFileSync(file, "utf8")}`);
      }
    },
  };
}

// Fixed names and one file each: the server knows what it serves, and the export can inline it.
export default defineConfig({
  base: "./",
  plugins: [licensed(), recorded()],
  build: {
    outDir: OUT,
    emptyOutDir: true,
    target: "es2022",
    modulePreload: false,
    cssCodeSplit: false,
    chunkSizeWarningLimit: 1500,
    rollupOptions: {
      output: { entryFileNames: "app.js", assetFileNames: "app[extname]", codeSplitting: false },
    },
  },
});
