// openapi.yaml as data: what the page of the HTTP interface shows. No drawing here.
export interface Schema {
  $ref?: string;
  type?: string;
  format?: string;
  description?: string;
  nullable?: boolean;
  enum?: string[];
  items?: Schema;
  allOf?: Schema[];
  required?: string[];
  properties?: Record<string, Schema>;
  default?: unknown;
}

export interface Parameter {
  name: string;
  in: string;
  required?: boolean;
  description?: string;
  schema: Schema;
}

export interface Content {
  required?: boolean;
  description?: string;
  content?: Record<string, { schema: Schema }>;
}

interface Ref {
  $ref: string;
}

export interface RawOperation {
  operationId: string;
  tags: string[];
  summary: string;
  description?: string;
  security?: unknown[];
  parameters?: (Parameter | Ref)[];
  requestBody?: Content | Ref;
  responses: Record<string, Content | Ref>;
}

export interface Description {
  info: { title: string; version: string; description: string };
  tags: { name: string; description: string }[];
  paths: Record<string, Record<string, RawOperation>>;
  components: { schemas: Record<string, Schema> } & Record<string, Record<string, unknown>>;
}

/// An operation whose references are followed, but for those to schemas, which have a place of their own.
export interface Operation {
  id: string;
  method: string;
  path: string;
  summary: string;
  description: string;
  open: boolean; // needs no token
  parameters: Parameter[];
  body?: Content;
  responses: [status: string, Content][];
}

export const schema_name = (ref: string): string => ref.split("/").at(-1)!;

function resolve<T>(api: Description, node: T | Ref): T {
  const ref = (node as Partial<Ref>).$ref;
  if (!ref) return node as T;
  const steps = ref.replace(/^#\//, "").split("/");
  return steps.reduce((at, step) => (at as Record<string, unknown>)[step], api as unknown) as T;
}

/// The operations of a tag, in the order of the file.
export function operations_of(api: Description, tag: string): Operation[] {
  return Object.entries(api.paths).flatMap(([path, methods]) =>
    Object.entries(methods)
      .filter(([, raw]) => raw.tags.includes(tag))
      .map(([method, raw]) => ({
        id: raw.operationId,
        method: method.toUpperCase(),
        path,
        summary: raw.summary,
        description: raw.description ?? "",
        open: raw.security?.length === 0,
        parameters: (raw.parameters ?? []).map((one) => resolve(api, one)),
        body: raw.requestBody && resolve(api, raw.requestBody),
        responses: Object.entries(raw.responses).map(([status, one]): [string, Content] => [status, resolve(api, one)]),
      })),
  );
}

export interface TypeText {
  before: string;
  ref?: string; // name of a schema
  after: string;
}

/// "list of Detection, or null"
export function type_text(schema: Schema): TypeText {
  const after = schema.nullable ? ", or null" : "";
  const single = schema.allOf?.length === 1 ? schema.allOf[0]! : schema;
  if (single.$ref) return { before: "", ref: schema_name(single.$ref), after };
  if (schema.type === "array" && schema.items) {
    const inner = type_text(schema.items);
    return { ...inner, before: `list of ${inner.before}`, after: inner.after + after };
  }
  if (schema.enum) return { before: schema.enum.join(" | "), after };
  return { before: (schema.format ?? schema.type ?? "anything") + after, after: "" };
}

export interface Property {
  name: string;
  schema: Schema;
  required: boolean;
}

/// All properties, those of the parts of `allOf`, too.
export function properties_of(api: Description, schema: Schema): Property[] {
  const parts = (schema.allOf ?? []).map((part) => resolve(api, part));
  const own = Object.entries(schema.properties ?? {}).map(([name, one]) => ({
    name,
    schema: one,
    required: schema.required?.includes(name) ?? false,
  }));
  return [...parts.flatMap((part) => properties_of(api, part)), ...own];
}

/// A line for the terminal that asks for it.
export function curl(operation: Operation, origin: string, token: boolean): string {
  const { method, path, body, responses } = operation;
  const words = ["curl"];
  if (responses[0]?.[1].content?.["text/event-stream"]) words.push("-N");
  const json = body?.content?.["application/json"]?.schema;
  if (method !== (body ? "POST" : "GET")) words.push(`-X ${method}`);
  if (token && !operation.open) words.push(`-H "Authorization: Bearer $POSEVOTE_TOKEN"`);
  if (json) words.push(`--json '${JSON.stringify(Object.fromEntries((json.required ?? []).map((name) => [name, "…"])))}'`);
  else if (body?.content) words.push(`--data-binary @${body.content["application/octet-stream"] ? "objects.posevote" : "picture.jpg"}`);
  const query = operation.parameters.filter((one) => one.in === "query" && one.required).map(({ name }) => `${name}=…`);
  const address = origin + path.replace(/\{(\w+)\}/g, (_, name: string) => name.toUpperCase());
  words.push(query.length ? `"${address}?${query.join("&")}"` : address);
  return words.join(" ");
}
