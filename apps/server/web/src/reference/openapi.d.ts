declare module "virtual:openapi" {
  const api: import("./description").Description;
  export default api;
}
